// Paths in stages: what is kept from one to the next, what comes into force and what goes.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <filesystem>

namespace {

const std::string there_and_back = "[path]\nsteps = 10\n[[stage]]\nname = \"load\"\nto = 0.4\n[[stage]]\nname = \"unload\"\nto = -0.4\n";

struct Tables {
  std::vector<TableRow> path, events;
};

Tables run(const ScratchDirectory& scratch, const std::string& text, const std::string& more = "") {
  const Answer answer = elamin_says("'" + scratch.file("p.toml", text) + "' --quiet " + more);
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  return {table_of(scratch / "p/path.csv"), table_of(scratch / "p/events.csv")};
}

}  // namespace

TEST_CASE("a truss that is loaded and unloaded snaps at other load factors: hysteresis", "[stages]") {
  const ScratchDirectory scratch;
  const auto [path, events] = run(scratch, truss + there_and_back);
  const TableRow down = row_of(events, "limit:1"), up = row_of(events, "limit:2");
  CHECK(down["lambda"] == Approx(truss_limit).epsilon(1e-12));
  CHECK(down["z"] == Approx(truss_limit_z).epsilon(1e-6));
  CHECK(up["lambda"] == Approx(-truss_limit).epsilon(1e-12));
  CHECK(up["z"] == Approx(-truss_limit_z).epsilon(1e-6));
  CHECK(down.text("stage") == "load");
  CHECK(up.text("stage") == "unload");
  for (const TableRow& row : path)                               // every equilibrium is one of the truss
    CHECK(row["lambda"] == Approx(truss_load(row["z"])).epsilon(1e-9).margin(1e-12));
  // On the same load factors the truss stands up while it is loaded, and hangs through while it is unloaded.
  const auto stands = [&](const std::string& stage, double lambda) {
    for (const TableRow& row : path)
      if (row.text("stage") == stage && std::abs(row["lambda"] - lambda) < 1e-12) return row["z"] > 0;
    throw std::out_of_range("no such row");
  };
  CHECK(stands("load", 0.08));
  CHECK_FALSE(stands("unload", 0.08));
  CHECK_FALSE(stands("unload", 0.0));
  CHECK_FALSE(stands("unload", -0.08));
  CHECK(path.back().text("label") == "final");
  CHECK(path.back()["z"] > 0.5);
  // Numbers go on: no step twice, branches and labels count through.
  for (std::size_t i = 0; i < path.size(); ++i) CHECK(path[i]["step"] == static_cast<double>(i));
  CHECK(path.back()["branch"] == 2);
  CHECK(path.back().text("parent") == "limit:2");
  CHECK(row_of(path, "load")["lambda"] == 0.4);                  // the end of a stage has its name
  CHECK(std::filesystem::exists(scratch / "p/states/load.data"));
  int initials = 0;
  for (const TableRow& row : path) initials += row.text("label") == "initial";
  CHECK(initials == 1);
}

TEST_CASE("an expectation may be about the end of a stage", "[stages]") {
  const ScratchDirectory scratch;
  const std::string expect = "[[expect]]\nobservable = \"lambda\"\nat = \"load\"\nvalue = 0.4\n";
  CHECK(elamin_says("verify --quiet '" + scratch.file("p.toml", truss + there_and_back + expect) + "'").status == 0);
  CHECK(elamin_says("verify --quiet '" + scratch.file("q.toml", truss + there_and_back + expect + "atol = 1\n[[expect]]\nobservable = \"z\"\nat = \"load\"\nvalue = 1\n") + "'").status == 3);
}

TEST_CASE("what a stage does not vary stays where it was left, and a support that enters holds things where they are", "[stages]") {
  // First the weight is put on to 0.05; then the apex is held there and pulled up by 0.3, and the weight stays; then the
  // hand lets go: back to where the weight alone holds it.
  const std::string text = truss + R"(
[[support]]
name = "hand"
group = "apex"
directions = "z"
displacement = [0, 0, 0.3]
from_stage = "pull"
[[observe]]
name = "hand"
group = "apex"
quantity = "reaction.z"
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
name = "let_go"
vary = "load.weight"
off = "support.hand"
to = 0.06
)";
  const ScratchDirectory scratch;
  const std::vector<TableRow> path = run(scratch, text).path;
  const double pressed = row_of(path, "press")["z"];
  CHECK(truss_load(pressed) == Approx(0.05).epsilon(1e-9));
  bool first = true;
  for (const TableRow& row : path) {
    if (row.text("stage") != "pull") continue;
    CHECK(row["z"] == Approx(pressed + 0.3 * row["lambda"]).epsilon(1e-14));
    CHECK(row["hand"] == Approx(0.05 - truss_load(row["z"])).epsilon(1e-9).margin(1e-12));   // the weight is still there
    if (first) CHECK(row["lambda"] == 0);
    first = false;
  }
  CHECK_FALSE(first);
  std::vector<TableRow> last;
  for (const TableRow& row : path)
    if (row.text("stage") == "let_go") last.push_back(row);
  REQUIRE(last.size() == 5);
  CHECK(last.front()["lambda"] == 0.05);                         // where the weight was left
  CHECK(last.front()["z"] == Approx(pressed).epsilon(1e-9));
  CHECK(last.back()["lambda"] == 0.06);
  CHECK(truss_load(last.back()["z"]) == Approx(0.06).epsilon(1e-9));
}

TEST_CASE("walls, loads and contacts are in force in their stages only", "[stages]") {
  // A grain under its weight on a floor; in the second stage the floor is off and a lower one catches it.
  const std::string text = R"(
[[grains]]
name = "ball"
positions = [[0, 0, 0.499]]
diameter = 1
[[support]]
group = "ball"
directions = "xy"
[[load]]
group = "ball"
force = [0, 0, -1e-3]
constant = true
[[load]]
name = "more"
group = "ball"
force = [0, 0, -1e-3]
[[wall]]
name = "upper"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
effective_modulus = 1
[[wall]]
name = "lower"
shape = "plane"
point = [0, 0, -2]
normal = [0, 0, 1]
effective_modulus = 1
[[observe]]
name = "upper_force"
group = "upper"
quantity = "reaction.z"
[[observe]]
name = "lower_force"
group = "lower"
quantity = "reaction.z"
[[observe]]
name = "z"
group = "ball"
quantity = "position.z"
[path]
steps = 2
[[stage]]
name = "above"
[[stage]]
name = "below"
off = ["wall.upper", "load.more"]
vary = []
to = 1
)";
  const ScratchDirectory scratch;
  const std::vector<TableRow> path = run(scratch, text).path;
  const TableRow above = row_of(path, "above"), below = path.back();
  CHECK(above["upper_force"] == Approx(2e-3).epsilon(1e-8));
  CHECK(above["lower_force"] == 0);
  CHECK(below["upper_force"] == 0);
  CHECK(below["lower_force"] == Approx(1e-3).epsilon(1e-8));
  CHECK(below["z"] < -1.5);
  CHECK(below["z"] > -1.6);
}

TEST_CASE("a wall of a later stage finds the particles where they are as it begins", "[stages]") {
  const std::string lifted = "[[grains]]\nname = \"a\"\npositions = [[0, 0, 1]]\ndiameter = 1\n[[support]]\ngroup = \"a\"\ndisplacement = [0, 0, 4]\n"
                             "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 2]\nnormal = [0, 0, 1]\nyoungs_modulus = 1\nfrom_stage = \"on\"\n"
                             "[path]\nsteps = 2\n[[stage]]\nname = \"up\"\nto = ";
  const ScratchDirectory scratch;
  run(scratch, lifted + "1\n[[stage]]\nname = \"on\"\nto = 2\n");
  const Answer below = elamin_says("'" + scratch.file("p.toml", lifted + "0.1\n[[stage]]\nname = \"on\"\nto = 2\n") + "' --quiet");
  CHECK(below.status == 2);
  CHECK(below.text.find("on: wall.floor.side: a 1 is outside of it, at [0, 0, 1.4]; it must be inside") != std::string::npos);
}
