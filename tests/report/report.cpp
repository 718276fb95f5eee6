#include "report/report.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "core/text.hpp"
#include "core/text_file.hpp"
#include "lammps/data.hpp"
#include "report/base64.hpp"
#include "report/run_data.hpp"
#include "results/stored_run.hpp"
#include "scratch_directory.hpp"
#include "study/run.hpp"
#include "study/truss.hpp"

#include <openssl/sha.h>

#include <algorithm>
#include <cstring>
#include <regex>
#include <set>

using namespace elamin;

namespace {

const std::string hostile = "</script><script>alert(1)</script><!-- & \"b\" 'c'";

/// A truss that snaps through.
const std::string hostile_problem = R"(title = "</script><script>alert(1)</script><!-- & \"b\" 'c'")" + truss + R"(
[path]
method = "arc_length"
steps = 10
to = 0.15
frames = 6
[[expect]]
observable = "z"
at = "final"
value = 12345
)";

std::string made(const ScratchDirectory& scratch, const std::string& text = hostile_problem) {
  RunOptions options;
  options.file = scratch.file("p.toml", text), options.directory = scratch / "run", options.threads = 1, options.quiet = true;
  REQUIRE(run(options).exit_status == exit_done);
  return options.directory;
}

/// Contents of all elements `name`, each cut out of the page.
std::vector<std::string> cut(std::string& page, const std::string& name) {
  std::vector<std::string> all;
  for (std::size_t at = 0; (at = page.find("<" + name, at)) != page.npos;) {
    const std::size_t begin = page.find('>', at) + 1, end = page.find("</" + name + ">", begin);
    all.push_back(page.substr(begin, end - begin));
    page.erase(begin, end - begin), at = begin;
  }
  return all;
}

std::string hash_of(const std::string& text) {
  std::vector<unsigned char> digest(SHA256_DIGEST_LENGTH);
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return "'sha256-" + base64(digest) + "'";
}

/// Every element that is opened is closed, the last one first.
void check_closed(const std::string& page) {
  const std::set<std::string> single{"meta", "input", "br", "!DOCTYPE"};
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-zA-Z0-9!]+)[^>]*>");
  for (std::sregex_iterator it(page.begin(), page.end(), tag); it != std::sregex_iterator(); ++it) {
    const std::string name = (*it)[2];
    if (single.count(name)) continue;
    if ((*it)[1] == "") {
      open.push_back(name);
      continue;
    }
    REQUIRE(!open.empty());
    CHECK(open.back() == name);
    open.pop_back();
  }
  CHECK(open.empty());
}

template <class Number> std::vector<Number> numbers(const std::string& text) {
  std::vector<unsigned char> bytes(text.size() + 1);
  EVP_DecodeBlock(bytes.data(), reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  const std::size_t count = 3 * text.size() / 4 - static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
  std::vector<Number> all(count / sizeof(Number));
  if (!all.empty()) std::memcpy(all.data(), bytes.data(), count);
  return all;
}
std::vector<float> floats(const std::string& text) { return numbers<float>(text); }

}  // namespace

TEST_CASE("a page is whole, and nothing from a file is markup or runs in it", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch), whole = report_page({{directory}, "", true});
  CHECK(whole.find("alert(1)</script>") == whole.npos);
  CHECK(whole.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)") != whole.npos);
  for (const char* name : {"{{policy}}", "{{title}}", "{{style}}", "{{data}}", "{{scripts}}", "{{licences}}", "{{version}}"})
    CHECK(whole.find(name) == whole.npos);

  std::string page = whole;
  const std::vector<std::string> scripts = cut(page, "script"), styles = cut(page, "style");
  REQUIRE(scripts.size() == 9);                                   // the data, three.js, its controls, d3, five of our own
  REQUIRE(styles.size() == 1);
  std::smatch policy;
  REQUIRE(std::regex_search(page, policy, std::regex("Content-Security-Policy\" content=\"([^\"]*)\"")));
  CHECK(policy[1].str().starts_with("default-src 'none';"));
  CHECK(policy[1].str().find("unsafe") == std::string::npos);
  for (std::size_t k = 1; k < scripts.size(); ++k) CHECK(policy[1].str().find(hash_of(scripts[k])) != std::string::npos);
  CHECK(policy[1].str().find(hash_of(styles[0])) != std::string::npos);
  CHECK(std::regex_search(page, std::regex("\\s(src|href|on[a-z]+|style)\\s*=|<(link|img|iframe|object|base)\\b")) == false);
  CHECK(std::regex_search(styles[0], std::regex("url\\(|@import")) == false);
  page.erase(page.find("<!--\n"), page.rfind("-->") + 3 - page.find("<!--\n"));    // the licences
  check_closed(page);
  CHECK(Json::parse(scripts[0])["runs"][0]["title"] == hostile);
}

TEST_CASE("a page holds the numbers of a run's files", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch);
  const Json data = run_data(directory, 1'000'000);
  const StoredRun run = read_run(directory);
  REQUIRE(run.path.rows.size() > 5);
  CHECK(data["path"]["columns"] == Json(run.path.columns));
  for (std::size_t c = 0; c < run.path.columns.size(); ++c)
    for (std::size_t r = 0; r < run.path.rows.size(); ++r) {
      const Json& there = data["path"]["values"][c][r];
      if (const auto value = as_number(run.path.rows[r][c])) CHECK((there.is_boolean() ? there == (*value != 0) : there == *value));
    }
  CHECK(data["events"]["values"][0].size() == run.events.rows.size());
  CHECK(data["input"]["text"] == hostile_problem);
  CHECK(data["status"] == "done");
  REQUIRE(data["expected"].size() == 1);
  CHECK(data["expected"][0]["met"] == false);
  CHECK(data["described"].get<std::string>().find("3 particles, 2 bonds") == 0);

  REQUIRE(data["states"]["list"].size() == run.states.size());
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    const Json& state = data["states"]["list"][k];
    CHECK(state["label"] == run.states[k].label);
    const Field x = read_lammps_data(run.states[k].file).position;
    const std::vector<float> shown = floats(state["x"]);
    REQUIRE(shown.size() >= static_cast<std::size_t>(x.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) CHECK(shown[i] == static_cast<float>(x.data()[i]));
    std::string bonds = run.states[k].file;
    const Table table = read_table(bonds.replace(bonds.rfind(".data"), 5, ".bonds.csv"));
    const std::vector<float> tension = floats(state["fields"]["tension"]);
    for (std::size_t b : {0, 1}) CHECK(tension[b] == Approx(*as_number(table.rows[b][table.column("tension")])).margin(1e-12));
  }

  int frames = 0;                                                 // beside the states that have a label
  const int z = run.path.column("z");
  for (const StoredState& s : run.states) {
    CHECK(*as_number(run.path.rows[static_cast<std::size_t>(s.row)][static_cast<std::size_t>(z)]) == read_lammps_data(s.file).position(2, 2));
    frames += s.label.empty();
  }
  CHECK((frames >= 3 && frames <= 4));

  const Json thin = run_data(directory, 1500);
  CHECK(thin["states"]["stored"] == run.states.size());
  CHECK(thin["states"]["kept"] == thin["states"]["list"].size());
  CHECK(thin["states"]["kept"] < run.states.size());
  CHECK(thin["states"]["list"].front()["label"] == "initial");
  CHECK(thin["states"]["list"].back()["label"] == "final");
}

TEST_CASE("a page of a refinement has its values", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch);
  CHECK(report_page({{directory}, "", true}).find("\"refined\":null") != std::string::npos);
  write_text(directory + "/refine.csv", "at,quantity,value,error,order,approach,level_1,level_2\nfinal,w,0.5,1e-3,2,asymptotic,0.25,0.4375\n");
  CHECK(report_page({{directory}, "", true}).find("[0.4375]") != std::string::npos);
}

TEST_CASE("a page has of every stage what was there", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch, read_text(std::string(ELAMIN_ROOT) + "/tests/input/good/staged.toml"));
  const StoredRun run = read_run(directory);
  const Json data = run_data(directory, 1'000'000), &structure = data["structure"];
  const std::vector<std::int32_t> pairs = numbers<std::int32_t>(structure["bonds"]), id = numbers<std::int32_t>(structure["id"]);
  REQUIRE(structure["stages"].size() == 3);
  REQUIRE(data["states"]["list"].size() == 4);
  const std::vector<std::size_t> absent{id.size() - 10, id.size() - 10, 0, 2};
  for (std::size_t k = 0; k < 4; ++k) {
    const Json &state = data["states"]["list"][k], &stage = structure["stages"][state["stage"].get<std::size_t>()];
    CHECK(numbers<std::int32_t>(stage["absent"]).size() == absent[k]);
    const std::vector<std::int32_t> unbound = numbers<std::int32_t>(stage["unbound"]);
    const std::vector<float> tension = floats(state["fields"]["tension"]);
    std::string file = run.states[k].file;
    const Table bonds = read_table(file.replace(file.rfind(".data"), 5, ".bonds.csv"));
    REQUIRE(bonds.rows.size() + unbound.size() == pairs.size() / 2);
    std::size_t row = 0;
    for (std::size_t b = 0; b < pairs.size() / 2; ++b) {
      if (std::find(unbound.begin(), unbound.end(), static_cast<int>(b)) != unbound.end()) {
        CHECK(tension[b] == 0);
        continue;
      }
      const auto number = [&](const char* column) { return *as_number(bonds.rows[row][bonds.column(column)]); };
      CHECK(number("first") == id[pairs[2 * b]]);
      CHECK(number("second") == id[pairs[2 * b + 1]]);
      CHECK(tension[b] == Approx(number("tension")).margin(1e-9));     // 1e6 times the rounding of a length
      ++row;
    }
  }
}

TEST_CASE("a page has of every stage what was in force", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch, R"(
[[grains]]
name = "ball"
positions = [[0, 0, 0.499]]
diameter = 1
[[support]]
group = "ball"
directions = "xy"
[[support]]
group = "ball"
from_stage = "held"
[[load]]
group = "ball"
force = [0, 0, -1e-3]
constant = true
[[load]]
name = "more"
group = "ball"
force = [0, 0, -1e-3]
[[wall]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
effective_modulus = 1
[path]
steps = 2
[[stage]]
name = "pressed"
[[stage]]
name = "held"
off = ["load.1", "wall.floor"]
vary = ["load.more"]
to = 0.5
)");
  const Json data = run_data(directory, 1'000'000), &stages = data["structure"]["stages"], &states = data["states"]["list"];
  REQUIRE(stages.size() == 2);
  CHECK(stages[0]["supports"] == Json({true, false}));
  CHECK(stages[1]["supports"] == Json({true, true}));
  CHECK(stages[0]["walls"] == Json::array({true}));
  CHECK(stages[1]["walls"] == Json::array({false}));
  REQUIRE(states.size() == 3);
  CHECK(states[0]["loads"] == Json({1.0, 0.0}));
  CHECK(states[1]["loads"] == Json({1.0, 1.0}));
  CHECK(states[2]["loads"] == Json({0.0, 0.5}));
}

TEST_CASE("a page says what is missing", "[report]") {
  ScratchDirectory scratch;
  const std::string directory = made(scratch);
  scratch.file("p.toml", hostile_problem + "# changed\n");
  CHECK(run_data(directory, 1000)["input"]["text"].is_null());
  std::filesystem::remove(directory + "/summary.json");
  CHECK(run_data(directory, 1000)["status"] == "interrupted");
  std::ofstream(directory + "/resolved.toml") << "nonsense = 1\n";
  CHECK(run_data(directory, 1000)["no_shape"].get<std::string>().find("resolved.toml:1:") != std::string::npos);
  CHECK_THROWS_AS(report_page({{scratch / "nothing"}, "", true}), InputError);
}
