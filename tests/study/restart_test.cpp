// A path that is taken up again from a stored state goes on with the same numbers.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace {

const std::set<std::string> energies{"energy", "bond", "angle", "contact", "wall", "cohesion", "external"};
const std::set<std::string> words{"label", "parent", "stage", "stable"};
const std::set<std::string> counted{"step", "branch", "iterations", "residual"};

/// "limit" of "limit:2". Which one is the last point depends on what else is traced.
std::string kind_of(const std::string& label) { return label == "final" ? "" : label.substr(0, label.find(':')); }

/// What is rounding's beside: of energies the largest of them on the whole path, of other columns their own largest number.
std::map<std::string, double> scales(const std::vector<TableRow>& rows) {
  std::map<std::string, double> largest;
  double energy = 0;
  for (const TableRow& row : rows)
    for (const auto& [column, cell] : row.cells) {
      if (words.count(column) || cell.empty()) continue;
      double& most = energies.count(column) ? energy : largest[column];
      most = std::max(most, std::abs(std::stod(cell)));
    }
  for (const std::string& column : energies) largest[column] = energy;
  return largest;
}

/// The same numbers to `tolerance` of the scale, and the same kinds of events: a path that is taken up counts anew.
void same_rows(const std::vector<TableRow>& rows, const std::vector<TableRow>& expected, const std::map<std::string, double>& scale,
               double tolerance) {
  REQUIRE(rows.size() == expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& [column, cell] : expected[i].cells) {
      if (counted.count(column) || (column == "parent" && rows[i].text("branch") == "0")) continue;    // 0: where it started
      INFO("row " << i << ", " << column << ": " << rows[i].text(column) << ", expected " << cell);
      if (words.count(column)) CHECK(kind_of(rows[i].text(column)) == kind_of(cell));
      else CHECK(std::abs(std::stod(rows[i].text(column)) - std::stod(cell)) <= tolerance * scale.at(column));
    }
}

enum class Continued { all, branch };

/// Runs the file, then again from each of its labelled states, and compares every row behind that state, or those on its
/// branch. `more`: further arguments of both. Gives the kinds of states that it began at.
std::set<std::string> compare_restarts(const std::string& text, const std::string& more = "", Continued compared = Continued::all) {
  constexpr double tolerance = 1e-12;
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", text);
  REQUIRE(elamin_says("'" + file + "' --quiet -o '" + (scratch / "whole") + "'" + more).status == 0);
  const std::vector<TableRow> whole = table_of(scratch / "whole/path.csv");
  const auto scale = scales(whole);
  std::set<std::string> kinds;
  for (std::size_t k = 0; k + 1 < whole.size(); ++k) {
    const std::string &label = whole[k].text("label"), &branch = whole[k].text("branch");
    if (label.empty()) continue;
    kinds.insert(kind_of(label));
    std::string state = label;
    std::replace(state.begin(), state.end(), ':', '-');
    INFO("from " << label);
    const Answer answer = elamin_says("'" + file + "' --quiet -o '" + (scratch / "rest") + "'" + more +
                                      " --set path.start='\"whole/states/" + state + ".data\"'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    std::vector<TableRow> rest = table_of(scratch / "rest/path.csv");
    std::vector<TableRow> expected(whole.begin() + static_cast<std::ptrdiff_t>(k) + 1, whole.end());
    REQUIRE(rest.front()["lambda"] == whole[k]["lambda"]);
    REQUIRE(rest.front()["energy"] == Approx(whole[k]["energy"]).epsilon(1e-14));
    rest.erase(rest.begin());
    if (compared == Continued::branch) {
      std::erase_if(expected, [&](const TableRow& r) { return r.text("branch") != branch; });
      std::erase_if(rest, [](const TableRow& r) { return r.text("branch") != "0"; });
    }
    same_rows(rest, expected, scale, tolerance);
  }
  return kinds;
}

std::string problem_text(const std::string& name) { return text_of(ELAMIN_ROOT "/problems/" + name + ".toml"); }

const std::string resumed_column = pressed_column_observed + R"(
[path]
steps = 10
[[expect]]
observable = "lambda"
at = "lambda=0.73"
value = 0.73
)";

}  // namespace

TEST_CASE("load steps go on from a stored state with the same numbers", "[restart]") {
  CHECK(compare_restarts(resumed_column) == std::set<std::string>{"initial", "branch", "jump"});
  CHECK(compare_restarts(truss + "[path]\nsteps = 30\nto = 0.1\n[[event]]\nname = \"low\"\nobservable = \"z\"\nvalue = 0.4\n") ==
        std::set<std::string>{"initial", "low", "limit", "jump"});
}

TEST_CASE("load steps go on at contacts, branch points, limit points and behind jumps", "[restart]") {
  const std::set<std::string> all{"initial", "branch", "jump", "contact", "limit"};
  CHECK(compare_restarts(problem_text("two_beams")) == all);
  CHECK(compare_restarts(problem_text("column_between_walls")) == all);
}

TEST_CASE("an arc-length path goes on at limit points and branch points, up or down", "[restart]") {
  CHECK(compare_restarts(problem_text("truss_tall")) == std::set<std::string>{"initial", "branch", "limit"});
  CHECK(compare_restarts(problem_text("arch_buckled")) == std::set<std::string>{"initial", "compression", "branch", "limit"});
  const std::string jumping = " --set path.when_unstable='\"jump\"'";
  CHECK(compare_restarts(problem_text("truss_tall"), jumping) == std::set<std::string>{"initial", "branch", "jump"});
}

TEST_CASE("an arc-length path goes on at contacts", "[restart]") {
  const std::string arc_length = " --set path.method='\"arc_length\"' --set path.when_unstable='\"follow\"'";
  CHECK(compare_restarts(problem_text("column_between_walls"), arc_length) == std::set<std::string>{"initial", "branch", "contact", "limit"});
}

TEST_CASE("a path that is taken up on a side branch goes on along it", "[restart]") {
  const std::string branches = resumed_column + "[[event]]\nname = \"bent\"\nobservable = \"z\"\nvalue = 5e-4\n";
  CHECK(compare_restarts(branches, " --set path.method='\"arc_length\"' --set path.branches=1", Continued::branch).count("bent"));
}

const std::string snapping = truss + R"(
[path]
method = "arc_length"
steps = 20
to = 0.2
[[event]]
name = "flat"
observable = "z"
value = 0
)";

TEST_CASE("the final state of an arc-length path knows where the path was heading", "[restart]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", snapping), run = "'" + file + "' --quiet -o '";
  REQUIRE(elamin_says(run + (scratch / "whole") + "'").status == 0);
  REQUIRE(elamin_says(run + (scratch / "half") + "' --set event.flat.stop=true").status == 0);
  REQUIRE(elamin_says(run + (scratch / "rest") + "' --set path.start='\"half/states/final.data\"'").status == 0);
  std::vector<TableRow> whole = table_of(scratch / "whole/path.csv"), rest = table_of(scratch / "rest/path.csv");
  const std::size_t behind = table_of(scratch / "half/path.csv").size();
  const auto scale = scales(whole);
  whole.erase(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(behind)), rest.erase(rest.begin());
  CHECK(whole.size() > 10);
  same_rows(rest, whole, scale, 1e-12);

  // Beyond its end it is another path.
  const Answer ended = elamin_says(run + (scratch / "none") + "' --set path.start='\"whole/states/final.data\"'");
  CHECK(ended.status == 1);
  CHECK(ended.text.find("is at the load factor where the path ends, ") != std::string::npos);
  CHECK(ended.text.find("; start_lambda = 0 begins a new path from this state, another `to` goes on with the old one") != std::string::npos);
  CHECK(elamin_says(run + (scratch / "new") + "' --set path.start='\"whole/states/final.data\"' --set path.start_lambda=0").status == 0);
}

TEST_CASE("an arc-length path goes on to another end than the one that it was to have", "[restart]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", R"(
plane = "xz"
[[beam]]
name = "c"
particles = 12
from = [0, 0, 0]
to = [1, 0, 0]
diameter = 0.01
axial_stiffness = 1e6
bending_stiffness = 1.0
[[group]]
name = "foot"
of = "c"
first = 2
[[group]]
name = "tip"
of = "c"
last = 1
[[support]]
group = "foot"
[[load]]
group = "tip"
force = [0, 0, -10]
[path]
method = "arc_length"
steps = 7
)"), run = "'" + file + "' --quiet -o '";
  REQUIRE(elamin_says(run + (scratch / "whole") + "'").status == 0);
  const TableRow end = table_of(scratch / "whole/path.csv").back();
  for (const std::string to : {"0.05", "0.23", "0.6"}) {
    REQUIRE(elamin_says(run + (scratch / "first") + "' --set path.to=" + to).status == 0);
    const Answer answer = elamin_says(run + (scratch / "then") + "' --set path.start='\"first/states/final.data\"'");
    INFO(to << " " << answer.text);
    REQUIRE(answer.status == 0);
    const TableRow last = table_of(scratch / "then/path.csv").back();
    CHECK(last["lambda"] == 1);
    CHECK(last["energy"] == Approx(end["energy"]).epsilon(1e-12));
  }
}

TEST_CASE("where a stored path was heading is left aside by any other path", "[restart]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", snapping), run = "'" + file + "' --quiet -o '";
  REQUIRE(elamin_says(run + (scratch / "p") + "'").status == 0);
  // From the flat truss, z = 0, the load falls along the path; a path of its own goes towards `to`.
  const auto change = [&](const std::string& more) {
    const Answer answer = elamin_says(run + (scratch / "q") + "' --set path.start='\"p/states/flat-1.data\"'" + more);
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const std::vector<TableRow> rows = table_of(scratch / "q/path.csv");
    return rows.at(2)["lambda"] - rows.at(0)["lambda"];                  // the row between may be the event once more
  };
  CHECK(change("") < 0);
  CHECK(change(" --set path.steps=25") < 0);
  CHECK(change(" --set path.start_lambda=1e-3") > 0);
  CHECK(change(" --set path.parameter='\"load.weight\"'") > 0);
  CHECK(change(" --set path.from=0.2 --set path.to=-0.2") < 0);
}

TEST_CASE("a stored state says in which stage it is, and a restart goes on there", "[restart]") {
  const std::string stages = "[path]\nsteps = 10\n[[stage]]\nname = \"load\"\nto = 0.4\n[[stage]]\nname = \"unload\"\nto = 0.1\n[[stage]]\nname = \"hold\"\nto = 0.05\n";
  CHECK(compare_restarts(truss + stages) == std::set<std::string>{"initial", "load", "unload", "limit", "jump"});
}

TEST_CASE("a support that entered before the state was stored goes on from there", "[restart]") {
  const std::string stages = R"(
[[support]]
name = "hand"
group = "apex"
directions = "z"
displacement = [0, 0, 0.3]
from_stage = "pull"
[path]
steps = 4
[[stage]]
name = "press"
vary = "load.weight"
to = 0.05
[[stage]]
name = "pull"
vary = "support.hand"
to = 1
[[stage]]
name = "back"
vary = "support.hand"
to = 0.5
)";
  CHECK(compare_restarts(truss + stages) == std::set<std::string>{"initial", "press", "pull"});
}

TEST_CASE("what stands beside a state", "[restart]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", resumed_column);
  REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
  const auto state = nlohmann::json::parse(text_of(scratch / "p/states/branch-1.json"));
  CHECK(state["lambda"].get<double>() == row_of(table_of(scratch / "p/events.csv"), "branch:1")["lambda"]);
  CHECK(state["tail"].size() == 14);
  CHECK_FALSE(state.contains("stage"));
  // Null vectors of the event: orthonormal, zero where the ends are held.
  const auto modes = csv_rows(scratch / "p/states/branch-1.modes.csv");
  REQUIRE(modes.size() == 15);
  CHECK(modes[0] == std::vector<std::string>{"id", "ux1", "uy1", "uz1"});
  double square = 0;
  for (std::size_t i = 1; i < modes.size(); ++i)
    for (int c = 1; c <= 3; ++c) square += std::stod(modes[i][c]) * std::stod(modes[i][c]);
  CHECK(square == Approx(1).epsilon(1e-12));
  CHECK(std::stod(modes[1][1]) == 0);
  CHECK(std::abs(std::stod(modes[7][1])) > 0.1);
  CHECK_FALSE(std::filesystem::exists(scratch / "p/states/initial.modes.csv"));

  const std::string again = "' --quiet -o '" + (scratch / "q") + "' --set path.start='\"p/states/jump-1.data\"'";
  scratch.file("p/states/jump-1.json", "{\"lambda\": 0.5, \"tail\": [[0, 0, 1]]}");
  const Answer other = elamin_says("'" + file + again);
  CHECK(other.status == 1);
  CHECK(other.text.find("are not of one state") != std::string::npos);
  scratch.file("p/states/jump-1.json", "{\"lambda\": \"a\"}");
  const Answer broken = elamin_says("'" + file + again);
  CHECK(broken.status == 1);
  CHECK(broken.text.find("jump-1.json: must hold {\"lambda\"") != std::string::npos);
  const std::string lambda = state["lambda"].dump(), tail = state["tail"].dump();
  for (const auto& [path, sentence] : std::vector<std::pair<std::string, std::string>>{
           {"[]", "path must be {\"varied\""},
           {R"({"varied": [], "rising": 1, "resume": {}})", "path must be {\"varied\""},
           {R"({"varied": [], "rising": true, "resume": {"modes": 3}})", "path.resume.modes must be arrays"},
           {R"({"varied": [], "rising": true, "resume": {"modes": [[1, 2], [3]]}})", "path.resume.modes has 1 numbers, and what stands before it 2"},
           {R"({"varied": [], "rising": true, "resume": {"modes": [[1]], "tangent": [1, 2]}})", "path.resume.tangent has 2 numbers"},
           {R"({"varied": [], "rising": true, "resume": {"tangent": ["a"]}})", "path.resume.tangent must be finite numbers"},
           {R"({"varied": [], "rising": true, "resume": {"direction": [1], "load": 1, "length": 0, "step": 1, "shortest": 1}})", "path.resume.length must be positive"},
           {R"({"varied": [], "rising": true, "resume": {"direction": [1]}})", "path.resume.load must be a finite number"},
           {R"({"varied": [], "rising": true, "resume": {"closed": [[0, 14, -1]]}})", "path.resume.closed must be contacts"},
           {R"({"varied": [], "rising": true, "resume": {"before": -2}})", "path.resume.before must be a number"},
           {R"({"varied": [], "rising": true, "resume": {"label": 1}})", "path.resume.label must be a text"}}) {
    INFO(path);
    scratch.file("p/states/branch-1.json", "{\"lambda\": " + lambda + ", \"path\": " + path + ", \"tail\": " + tail + "}");
    const Answer mistake = elamin_says("'" + file + "' --quiet -o '" + (scratch / "q") + "' --set path.start='\"p/states/branch-1.data\"'");
    CHECK(mistake.status == 1);
    CHECK(mistake.text.find("branch-1.json: " + sentence) != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(scratch / "q"));
}
