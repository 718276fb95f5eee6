// Structures that come and go with the stages of a path.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"

using Catch::Matchers::Contains;

namespace {

// Two springs in a row along x, K = 1 and r₀ = 1 each, between a wall's particle, a middle one and a tip that a support moves.
const std::string springs = R"(
[[grains]]
name = "wall"
positions = [[0, 0, 0]]
diameter = 0.1
[[grains]]
name = "tip"
positions = [[2, 0, 0]]
diameter = 0.1
[[grains]]
name = "middle"
positions = [[1.25, 0, 0]]
diameter = 0.1
from_stage = "join"
[[connect]]
between = ["wall", "tip"]
within = 3
bond_stiffness = 1
[[connect]]
between = ["middle", "wall"]
from_stage = "join"
within = 1.5
bond_stiffness = 1
rest_length = 1
[[connect]]
between = ["middle", "tip"]
from_stage = "join"
within = 2
bond_stiffness = 1
[[support]]
group = "wall"
[[support]]
group = "tip"
displacement = [1, 0, 0]
[[support]]
group = "middle"
directions = "yz"
from_stage = "join"
[[observe]]
name = "x"
group = "middle"
quantity = "position.x"
[[observe]]
name = "force"
group = "tip"
quantity = "reaction.x"
[path]
steps = 2
)";

struct Staged {
  int status;
  std::string text;
  std::vector<TableRow> path;
};

Staged run_staged(const ScratchDirectory& scratch, const std::string& text) {
  const Answer answer = elamin_says("'" + scratch.file("p.toml", text) + "' --quiet");
  INFO(answer.text);
  return {answer.status, answer.text, answer.status == 1 ? std::vector<TableRow>{} : table_of(scratch / "p/path.csv")};
}

const TableRow& end_of(const std::vector<TableRow>& path, const std::string& stage) {
  const TableRow* last = nullptr;
  for (const TableRow& row : path)
    if (row.text("stage") == stage) last = &row;
  REQUIRE(last);
  return *last;
}

}  // namespace

TEST_CASE("a particle that comes with a stage is connected to where things are by then", "[stages]") {
  const ScratchDirectory scratch;
  const Staged r = run_staged(scratch, springs + "[[stage]]\nname = \"pull\"\nto = 0.5\n[[stage]]\nname = \"join\"\nto = 1\n");
  REQUIRE(r.status == 0);
  // Alone the bond of length 2 is pulled: F = 2K (L − 2). The middle one stays where it is until it comes.
  for (const TableRow& row : r.path) {
    if (row.text("stage") != "pull") continue;
    CHECK(row["x"] == 1.25);
    CHECK(row["force"] == Approx(2 * row["lambda"]).epsilon(1e-13).margin(1e-15));
  }
  // It comes with the tip at 2.5: its bond to there has the length 1.25, to the wall r₀ = 1 and 1.25 as built. In balance
  // x − 1 = 2 + λ − x − 1.25.
  for (const TableRow& row : r.path) {
    if (row.text("stage") != "join") continue;
    const double x = (2 + row["lambda"] - 0.25) / 2;
    CHECK(row["x"] == Approx(x).epsilon(1e-13));
    CHECK(row["force"] == Approx(2 * row["lambda"] + 2 * (x - 1)).epsilon(1e-13));
  }
  CHECK(r.path.back()["lambda"] == 1);
}

TEST_CASE("bonds, and particles with all that is on them, are removed", "[stages]") {
  const std::string stages = "[[stage]]\nname = \"pull\"\nto = 0.5\n[[stage]]\nname = \"join\"\nto = 1\n[[stage]]\nname = \"last\"\nto = 1.5\n";
  const ScratchDirectory scratch;
  SECTION("the middle particle") {
    const Staged r = run_staged(scratch, springs + stages + "[[remove]]\ngroup = \"middle\"\nfrom_stage = \"last\"\n");
    REQUIRE(r.status == 0);
    const TableRow& last = end_of(r.path, "last");
    CHECK(last["x"] == end_of(r.path, "join")["x"]);             // it stays where it was
    CHECK(last["force"] == Approx(2 * 1.5).epsilon(1e-13));
  }
  SECTION("the bond between wall and tip") {
    const Staged r = run_staged(scratch, springs + stages + "[[group]]\nname = \"ends\"\nof = [\"wall\", \"tip\"]\n[[remove]]\ngroup = \"ends\"\nwhat = \"bonds\"\nfrom_stage = \"last\"\n");
    REQUIRE(r.status == 0);
    const TableRow& last = end_of(r.path, "last");
    CHECK(last["x"] == Approx((2 + 1.5 - 0.25) / 2).epsilon(1e-13));
    CHECK(last["force"] == Approx(2 * ((2 + 1.5 - 0.25) / 2 - 1)).epsilon(1e-13));
  }
}

TEST_CASE("angles are removed, and a beam that is bent goes straight", "[stages]") {
  const std::string text = R"(plane = "xz"
[[beam]]
name = "beam"
particles = 5
from = [0, 0, 0]
to = [4, 0, 0]
diameter = 1
bond_stiffness = 100
angle_stiffness = 1
[[group]]
name = "foot"
first = 2
[[group]]
name = "hinge"
ids = [2, 3, 4]
[[group]]
name = "tip"
last = 1
[[support]]
group = "foot"
[[load]]
group = "tip"
force = [0, 0, 0.01]
[[observe]]
name = "z"
group = "tip"
quantity = "position.z"
[[observe]]
name = "x"
group = "tip"
quantity = "position.x"
[path]
steps = 1
[[stage]]
name = "bend"
[[stage]]
name = "loose"
vary = []
from = 0
to = 1
[[remove]]
group = "hinge"
what = "angles"
from_stage = "loose"
)";
  const ScratchDirectory scratch;
  const Staged r = run_staged(scratch, text);
  REQUIRE(r.status == 0);
  CHECK(end_of(r.path, "bend")["z"] > 0.05);
  CHECK(end_of(r.path, "bend")["z"] < 0.2);
  CHECK(end_of(r.path, "loose")["x"] == Approx(2).margin(0.02));    // what is left hangs from particle 3, along the force
  CHECK(end_of(r.path, "loose")["z"] > 1.9);
}

TEST_CASE("a connection that makes no bond by then, and a path taken up behind one, say so", "[stages]") {
  const ScratchDirectory scratch;
  std::string far = springs + "[[stage]]\nname = \"pull\"\nto = 0.5\n[[stage]]\nname = \"join\"\nto = 1\n";
  far.replace(far.find("within = 2\n"), 11, "within = 1\n");
  const Staged r = run_staged(scratch, far);
  CHECK(r.status == 2);
  CHECK_THAT(r.text, Contains("join: connect.3 makes no bond: no particle of \"tip\" is within 1 of one of \"middle\""));
  CHECK(r.path.back().text("stage") == "pull");
  const ScratchDirectory other;
  const std::string whole = springs + "[[stage]]\nname = \"pull\"\nto = 0.5\n[[stage]]\nname = \"join\"\nto = 1\n";
  REQUIRE(run_staged(other, whole).status == 0);
  const Answer again = elamin_says("'" + (other / "p.toml") + "' --quiet -o '" + (other / "again") + "' --set path.start='\"" +
                                   (other / "p/states/final.data") + "\"'");
  CHECK(again.status != 0);
  CHECK_THAT(again.text, Contains("is not taken up behind a [[connect]] with from_stage"));
}

// A ball over another one that has gone down, U = k δ²/2, comes with the second stage, with the grain that it carries: under a weight F it falls to where δ = F/k.
TEST_CASE("a body comes with a stage, with what it carries", "[stages]") {
  const ScratchDirectory scratch;
  const auto ball = [](const std::string& name, const std::string& z, const std::string& more) {
    return "[[body]]\nname = \"" + name + "\"\nshape = \"sphere\"\nrounding_diameter = 1\nposition = [0, 0, " + z + "]\n" + more;
  };
  const std::string text = ball("base", "0", "") + ball("ball", "1", "from_stage = \"loaded\"\n") + R"(
[[grains]]
name = "mark"
positions = [[0, 0, 2]]
diameter = 0.1
[[glue]]
group = "mark"
body = "ball"
[[contact]]
between = ["base", "ball"]
law = "rounded"
k_n = 100
[[support]]
group = "base"
displacement = [0, 0, 0.5]
[[support]]
group = "ball"
directions = "xy"
rotations = "xyz"
[[load]]
name = "weight"
group = "ball"
force = [0, 0, -2]
[[observe]]
name = "base"
group = "base"
quantity = "position.z"
[[observe]]
name = "ball"
group = "ball"
quantity = "position.z"
[[observe]]
name = "mark"
group = "mark"
quantity = "position.z"
[path]
steps = 2
[[stage]]
name = "alone"
vary = ["support.1"]
from = 0
to = -1
[[stage]]
name = "loaded"
vary = ["load.weight"]
from = 0
to = 1
)";
  const Staged r = run_staged(scratch, text);
  INFO(r.text);
  REQUIRE(r.status == 0);
  CHECK(end_of(r.path, "alone")["ball"] == 1);
  CHECK(end_of(r.path, "alone")["mark"] == 2);
  CHECK(end_of(r.path, "alone")["base"] == -0.5);
  const TableRow& end = end_of(r.path, "loaded");
  CHECK(end["mark"] == Approx(end["ball"] + 1).epsilon(1e-13));
  const double sunk = 2 / 100.0, place = 0.5 - sunk;
  CHECK(end["ball"] == Approx(place).epsilon(1e-12));
  CHECK(end["energy"] == Approx(100 * sunk * sunk / 2 + 2 * place).epsilon(1e-12));
}
