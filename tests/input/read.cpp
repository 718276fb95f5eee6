#include "catch.hpp"

#include "input/document.hpp"
#include "input/key_tree.hpp"
#include "input/model_of.hpp"
#include "input/resolved.hpp"
#include "core/text.hpp"
#include "scratch_directory.hpp"

#include <bit>
#include <random>

using namespace elamin;

namespace {


const char* minimal = R"(
[[beam]]
name = "column"
particles = 5
from = [0, 0, 0]
to = [0, 0, 8]
diameter = 2
youngs_modulus = 3
[[support]]
group = "column"
)";

/// The problem that the file's resolved form holds, read from another folder.
Problem again(const Problem& problem) {
  const ScratchDirectory scratch;
  Problem p = read_problem(scratch.file("resolved.toml", resolved_toml(problem)));
  p.file = problem.file, p.sha256 = problem.sha256;
  return p;
}

/// The keys of the schema below a table, dotted.
void all_keys(const KeyTree& tree, const std::string& path, std::vector<std::string>& keys) {
  for (const KeyTree& below : tree.keys) {
    if (below.level == KeyTree::Level::value)
      keys.push_back(path + below.name);
    else
      all_keys(below, path + below.name + ".", keys);
  }
}

}  // namespace

TEST_CASE("A minimal problem has its defaults") {
  const ScratchDirectory scratch;
  const Problem p = read_problem(scratch.file("p.toml", minimal));
  REQUIRE(p.beams.size() == 1);
  const BeamTable& b = p.beams[0];
  CHECK(b.name == "column");
  CHECK(b.section == Section::cylinder);
  CHECK(b.particles == 5);
  CHECK(*b.to == Vec3(0, 0, 8));
  CHECK(b.thickness == 2.0);
  CHECK_FALSE(b.spacing);
  CHECK_FALSE(b.density);
  CHECK(p.supports[0].directions == "xyz");
  CHECK(p.supports[0].displacement == Vec3::Zero());
  CHECK(p.study == StudyType::equilibrium);
  CHECK(p.plane == "");
  CHECK(p.solver.tolerance == 1e-10);
  CHECK(p.solver.max_iterations == 200);
  CHECK(p.path.steps == 100);
  CHECK(p.path.locate == std::vector<std::string>{"limit", "branch", "contact"});
  CHECK(p.file == scratch / "p.toml");
  CHECK(p.beams[0].place.line == 2);
  CHECK(p.beams[0].place.key == "beam.column");
  CHECK(p.supports[0].place.key == "support.1");
  CHECK(p.supports[0].place.keys.at("group").line == 10);
}

TEST_CASE("The study is a path where a path is asked for, and a reaction is summed") {
  const ScratchDirectory scratch;
  const std::string observe = "[[observe]]\nname = \"f\"\ngroup = \"all\"\nquantity = \"reaction.x\"\n"
                              "[[observe]]\nname = \"u\"\ngroup = \"all\"\nquantity = \"displacement.norm\"\n";
  const Problem p = read_problem(scratch.file("p.toml", std::string(minimal) + "[path]\n" + observe));
  CHECK(p.study == StudyType::path);
  CHECK(p.observe[0].reduce == Reduce::sum);
  CHECK(p.observe[1].reduce == Reduce::mean);
  CHECK(p.observe[1].component == Component::norm);
  CHECK(p.observe[1].quantity == Quantity::displacement);
  CHECK(read_problem(scratch.file("q.toml", std::string(minimal) + "[path]\n[study]\ntype = \"energy\"")).study ==
        StudyType::energy);
}

TEST_CASE("The hash is SHA-256 of the bytes") {
  // FIPS 180-4, example "abc".
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const ScratchDirectory scratch;
  CHECK(read_problem(scratch.file("p.toml", minimal)).sha256 == sha256(minimal));
}

TEST_CASE("The resolved problem reads back to the same problem") {
  for (const char* name : {"column.toml", "everything.toml", "structures.toml", "beams.toml", "path.toml", "stages.toml", "staged.toml", "dynamics.toml", "bodies.toml",
                           "falling.toml", "observed.toml", "landscape.toml", "constants.toml", "shapes.toml", "shapes_random.toml", "shapes_state.toml"}) {
    const Problem p = read_problem(good + name);
    INFO(resolved_toml(p));
    CHECK(again(p) == p);
    CHECK(resolved_toml(again(p)) == resolved_toml(p));
  }
  Problem other = read_problem(good + "everything.toml");
  other.loads[1].total_force->z() = std::nextafter(3, 4);
  CHECK_FALSE(other == read_problem(good + "everything.toml"));
  CHECK(again(other) == other);
}

TEST_CASE("Expressions have the values that they say") {
  const ScratchDirectory scratch;
  const auto column = [&](const std::vector<Setting>& settings) { return read_problem(good + "constants.toml", settings); };
  const Problem p = column({});
  CHECK(p.beams[0].particles == 41);
  CHECK(p.beams[0].from->z() == -0.02);
  CHECK(p.beams[0].to->z() == 0.02);
  CHECK(p.beams[0].diameter == 1e-3);
  CHECK(p.beams[0].rest.degrees == 180);
  CHECK(p.groups[0].ids == std::vector<int>{1, 2, 40, 41});
  CHECK(p.expect[0].value == 0);                      // ^ binds before the sign
  CHECK(resolved_toml(p).find("t = 0.001\nn = 40.0\nL = 0.04") != std::string::npos);
  // One constant moves all that follows from it.
  const Problem thick = column({{"constants.t", "2e-3"}});
  CHECK(thick.beams[0].diameter == 2e-3);
  CHECK(thick.beams[0].to->z() == 0.04);
  CHECK(column({{"constants.n", "'20*4'"}}).beams[0].particles == 81);
  const auto value = [](const std::string& expression) { return Constants().value(expression).value.value(); };
  CHECK(value("2^3^2") == 512);
  CHECK(value("-2^2") == -4);
  CHECK(value("2^-1") == 0.5);
  CHECK(value("8/2/2*3-1-1") == 4);
  CHECK(value("-(1 + .5)*1e1") == -15);
  CHECK(value("min(3, 2, 5) + max(1, 4) + abs(-1)") == 7);
  CHECK(value("acos(-1)") == pi);
  CHECK(value("atan(tan(0.5)) - asin(sin(0.5))") == 0);
  CHECK(std::abs(value("log(exp(2)) - sqrt(4)*cos(0)")) < 1e-15);
}

TEST_CASE("The resolved problems hold every key") {
  std::vector<std::string> all;
  all_keys(key_tree(), "", all);
  const ScratchDirectory scratch;
  std::vector<Node> roots;
  for (const char* name : {"everything.toml", "structures.toml", "beams.toml", "path.toml", "stages.toml", "staged.toml", "dynamics.toml", "bodies.toml",
                           "falling.toml", "observed.toml", "landscape.toml", "constants.toml", "refined.toml", "shapes.toml", "shapes_random.toml", "shapes_state.toml"})
    roots.push_back({{}, read_document(scratch.file("r.toml", resolved_toml(read_problem(good + name)))).root});
  // A key is there if one of the tables of its name has it.
  const auto has = [](const auto& self, const Node& node, const std::string& key) -> bool {
    if (const auto* list = std::get_if<List>(&node.value)) {
      for (const Node& n : *list)
        if (self(self, n, key)) return true;
      return key.empty();
    }
    if (key.empty()) return true;
    const auto* entries = std::get_if<Entries>(&node.value);
    const std::size_t dot = std::min(key.find('.'), key.size());
    const Node* below = entries ? find(*entries, key.substr(0, dot)) : nullptr;
    return below && self(self, *below, dot == key.size() ? "" : key.substr(dot + 1));
  };
  CHECK(all.size() > 140);
  for (const std::string& key : all)
    if (key.compare(0, 6, "sweep.") != 0 && key.compare(0, 7, "lammps.") != 0) {
      INFO(key);
      CHECK(std::any_of(roots.begin(), roots.end(), [&](const Node& root) { return has(has, root, key); }));
    }
}

TEST_CASE("Numbers survive being written and read, bit for bit") {
  std::mt19937_64 random(7);
  std::vector<double> numbers{
      0.0, -0.0, 1.0, 0.1, 1e22, 1e23, 1e-10, -1e300, 1.7976931348623157e308, 2.2250738585072014e-308, 123456789};
  while (numbers.size() < 3000)
    if (const double x = std::bit_cast<double>(random()); std::isnormal(x)) numbers.push_back(x);
  for (const double x : numbers) {
    const Node node = parse_value(to_toml(x), {});
    REQUIRE(std::holds_alternative<double>(node.value));
    REQUIRE(std::bit_cast<std::uint64_t>(std::get<double>(node.value)) == std::bit_cast<std::uint64_t>(x));
  }
}

TEST_CASE("Strings survive being written and read") {
  for (const std::string text :
       {"", "plain", "\"quoted\" \\ back", "line\nbreak\ttab\r\x7f\x01", "ünïcode € 𝄞", "# no comment", "'''"}) {
    const Node node = parse_value(to_toml(text), {});
    REQUIRE(std::holds_alternative<std::string>(node.value));
    CHECK(std::get<std::string>(node.value) == text);
  }
}

TEST_CASE("Settings change keys, add those that are allowed, and reach into lists") {
  const std::string file = good + "everything.toml";
  const Problem before = read_problem(file);
  const Problem p = read_problem(file, {{"path.steps", "7"},
                                        {"beam.column.youngs_modulus", "2e6"},
                                        {"beam.2.density", "5"},
                                        {"beam.arm.axis.1", "-3"},
                                        {"support.1.displacement", "[0.2, 0, 0]"},
                                        {"support.3.constant", "true"},
                                        {"group.near.inside.hi.1", "2.3"},
                                        {"solver.tolerance", "1e-6"},
                                        {"title", "two words"},
                                        {"path.when_unstable", "jump"},
                                        {"load.1.constant", "false"}});
  CHECK(p.path.steps == 7);
  CHECK(p.beams[0].youngs_modulus == 2e6);
  CHECK(p.beams[1].density == 5.0);
  CHECK(*p.beams[1].axis == Vec3(-3, 0, 4));
  CHECK(p.supports[0].displacement == Vec3(0.2, 0, 0));
  CHECK(p.supports[2].constant);
  CHECK(p.groups[4].inside->region.hi.x() == 2.3);
  CHECK(p.solver.tolerance == 1e-6);
  CHECK(p.title == "two words");
  CHECK(p.path.when_unstable == WhenUnstable::jump);
  CHECK_FALSE(p.loads[0].constant);
  CHECK(p.loads[1] == before.loads[1]);
  CHECK(p.sha256 == before.sha256);
}

TEST_CASE("A setting may make a table, and the last of two settings holds") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", minimal);
  const Problem p =
      read_problem(file, {{"path.to", "0.5"}, {"path.to", "0.25"}, {"study.type", "equilibrium"}, {"plane", "yz"}});
  CHECK(p.path.to == 0.25);
  CHECK(p.study == StudyType::equilibrium);
  CHECK(p.plane == "yz");
  CHECK(read_problem(file, {{"path.to", "0.5"}}).study == StudyType::path);
  const Setting s = parse_setting("title=a=b");
  CHECK(s.key == "title");
  CHECK(s.value == "a=b");
}

TEST_CASE("File names are sought from the folder of the problem file") {
  const ScratchDirectory scratch;
  std::filesystem::create_directories(scratch / "states");
  scratch.file("states/s.data", "");
  const Problem p =
      read_problem(scratch.file("p.toml", std::string(minimal) + "[path]\nstart = \"./states/../states/s.data\""));
  CHECK(p.path.start == scratch / "states/s.data");
  CHECK(p.path.start_lambda == 0.0);
  CHECK(again(p) == p);
}
