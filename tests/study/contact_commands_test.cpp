#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

TEST_CASE("contacts, gaps and walls are energies, columns and observables", "[study]") {
  const ScratchDirectory scratch;
  // Two spheres of diameter 1 overlap by 0.1 and stand 0.05 deep in a floor; a third is 2 away from the upper one.
  const std::string file = scratch.file("grains.toml", R"(
[[grains]]
name = "sand"
positions = [[0, 0, 0.45], [0, 0, 1.35], [0, 0, 4.35]]
diameter = 1
[[contact]]
between = ["sand", "sand"]
law = "hertz"
effective_modulus = 300
[[wall]]
name = "floor"
group = "sand"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
effective_modulus = 75
[study]
type = "energy"
[[observe]]
name = "nearest"
group = "sand"
quantity = "gap"
[[observe]]
name = "farthest"
group = "sand"
quantity = "gap"
reduce = "max"
[[observe]]
name = "closed"
group = "sand"
quantity = "contacts"
[[observe]]
name = "push"
group = "floor"
quantity = "reaction.z"
[[observe]]
name = "depth"
group = "floor"
quantity = "gap"
)");
  // U = 8/15 E √R δ^{5/2}, F = 4/3 E √R δ^{3/2};  R = 1/4 of the pair, 1/2 at the floor.
  const double pair = 8.0 / 15 * 300 * 0.5 * std::pow(0.1, 2.5), floor = 8.0 / 15 * 75 * std::sqrt(0.5) * std::pow(0.05, 2.5);
  const double push = 4.0 / 3 * 75 * std::sqrt(0.5) * std::pow(0.05, 1.5);
  const Answer energy = elamin_says("energy --json '" + file + "'");
  INFO(energy.text);
  REQUIRE(energy.status == 0);
  const auto terms = nlohmann::json::parse(energy.text)["energy"];
  const double rounding = 1e-14;                                // of the overlaps, relative to them and times 5/2
  CHECK(terms["contact"].get<double>() == Approx(pair).epsilon(rounding));
  CHECK(terms["wall"].get<double>() == Approx(floor).epsilon(rounding));
  CHECK(terms["cohesion"] == 0.0);
  CHECK(terms["total"].get<double>() == Approx(pair + floor).epsilon(rounding));
  const Answer text = elamin_says("energy '" + file + "'");
  for (const char* term : {"contact", "wall", "cohesion"}) CHECK(text.text.find(term) != std::string::npos);

  const Answer answer = elamin_says("'" + file + "' --quiet -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const auto final = nlohmann::json::parse(text_of(scratch / "out/summary.json"))["final"];
  CHECK(final["contact"].get<double>() == Approx(pair).epsilon(rounding));
  CHECK(final["nearest"].get<double>() == Approx(-0.1).epsilon(1e-14));
  CHECK(final["farthest"].get<double>() == Approx(2).epsilon(1e-14));
  CHECK(final["closed"] == 3.0);
  CHECK(final["push"].get<double>() == Approx(push).epsilon(rounding));
  CHECK(final["depth"].get<double>() == Approx(-0.05).epsilon(1e-14));
  const auto rows = csv_rows(scratch / "out/contacts.csv");
  REQUIRE(rows.size() == 3);
  CHECK(rows[1][2] == "1");
  CHECK(rows[1][3] == "2");
  CHECK(rows[2][3] == "floor");
  CHECK(std::stod(rows[2][8]) == Approx(push).epsilon(rounding));

  const Answer check = elamin_says("check '" + file + "'");
  INFO(check.text);
  CHECK(check.status == 0);
  for (const char* words : {"grains 'sand': 3 particles", "diameters 1, no density", "hertz, E_eff = 300, r_eff = 0.25", "1 overlap at the start, the deepest 0.1\n",
                            "wall 'floor' of 'sand': inside of a plane", "E_eff = 75", "1 overlap at the start, the deepest 0.05\n", "free rigid motion"})
    CHECK(check.text.find(words) != std::string::npos);
}

TEST_CASE("an equilibrium is sought on a way that leads through nothing", "[study]") {
  const ScratchDirectory scratch;
  // A lid comes down from far above, beyond the place of the sphere, and squeezes it by 0.02.
  const std::string squeezed = scratch.file("squeezed.toml", R"(
[[grains]]
name = "ball"
positions = [[0, 0, 0.5]]
diameter = 1
[[wall]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
effective_modulus = 10
[[wall]]
name = "lid"
shape = "plane"
point = [0, 0, 10.98]
normal = [0, 0, -1]
effective_modulus = 10
displacement = [0, 0, -10]
[study]
type = "equilibrium"
[[observe]]
name = "push"
group = "lid"
quantity = "reaction.z"
[[observe]]
name = "z"
group = "ball"
quantity = "position.z"
)");
  Answer answer = elamin_says("'" + squeezed + "' -o '" + (scratch / "squeezed") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  auto final = nlohmann::json::parse(text_of(scratch / "squeezed/summary.json"))["final"];
  CHECK(final["push"].get<double>() == Approx(-4.0 / 3 * 10 * std::sqrt(0.5) * std::pow(0.01, 1.5)).epsilon(1e-12));
  CHECK(final["z"].get<double>() == Approx(0.49).epsilon(1e-12));
  CHECK(csv_rows(scratch / "squeezed/contacts.csv").size() == 3);

  // A sphere that is pushed onto the middle of a clamped beam, by more than both radii, bends it and does not pass.
  const std::string pushed = scratch.file("pushed.toml", R"(
plane = "xz"
[[beam]]
name = "beam"
particles = 21
from = [-10, 0, 0]
to = [10, 0, 0]
diameter = 1
youngs_modulus = 1000
[[grains]]
name = "ball"
positions = [[0, 0, 3]]
diameter = 2
[[contact]]
between = ["beam", "ball"]
law = "hertz"
effective_modulus = 1000
[[group]]
name = "left"
of = "beam"
first = 2
[[group]]
name = "right"
of = "beam"
last = 2
[[support]]
group = "left"
[[support]]
group = "right"
[[support]]
group = "ball"
displacement = [0, 0, -4]
[study]
type = "equilibrium"
[[observe]]
name = "push"
group = "ball"
quantity = "reaction.z"
[[observe]]
name = "lowest"
group = "beam"
quantity = "position.z"
reduce = "min"
)");
  answer = elamin_says("'" + pushed + "' -o '" + (scratch / "pushed") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  final = nlohmann::json::parse(text_of(scratch / "pushed/summary.json"))["final"];
  CHECK(final["lowest"].get<double>() < -2.4);                   // the ball's centre is at −1, the radii are 1 and ½
  CHECK(final["push"].get<double>() < 0);
  CHECK(final["stable"] == true);
  CHECK(csv_rows(scratch / "pushed/contacts.csv").size() >= 2);
}

TEST_CASE("what cannot be brought past each other is said, not passed through", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("driven.toml", R"(
[[grains]]
name = "a"
positions = [[0, 0, 0]]
diameter = 1
[[grains]]
name = "b"
positions = [[3, 0, 0]]
diameter = 1
[[grains]]
name = "aside"
positions = [[0, 9, 0]]
diameter = 1
[[contact]]
between = ["a", "b"]
law = "hertz"
effective_modulus = 1
[[support]]
group = "a"
[[support]]
group = "b"
displacement = [-6, 0, 0]
[study]
type = "equilibrium"
)");
  const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  CHECK(answer.status == 2);
  CHECK(answer.text.find("something would pass through something else") != std::string::npos);
  const auto final = nlohmann::json::parse(text_of(scratch / "out/summary.json"))["final"];
  CHECK(final["lambda"].get<double>() <= 0.5);                   // where the centres meet
}

TEST_CASE("check describes loops, sheets and connections", "[study]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("check '" + scratch.file("all.toml", R"(
[[loop]]
name = "ring"
section = "square"
particles = 6
radius = 2
diameter = 2
youngs_modulus = 3
rest = "as_built"
[[sheet]]
name = "plate"
shape = "rectangle"
size = [4, 2]
center = [20, 1, 0]
spacing = 1
thickness = 2
youngs_modulus = 3
[[sheet]]
name = "tube"
shape = "cylinder"
center = [0, 20, 0]
radius = 2
height = 3
spacing = 1
youngs_modulus = 3
[[grains]]
name = "sand"
positions = [[0, 0, 40], [0, 0, 50], [0, 0, 60]]
diameter = 1
density = 6
[[connect]]
between = ["ring", "plate"]
within = 16.001
bond_stiffness = 5
[[bonds]]
rule = "nearest"
between = ["sand", "sand"]
bonds_per_particle = 1
bond_stiffness = 7
[[bonds]]
pairs = [[1, 3]]
between = ["sand", "sand"]
axial_stiffness = 4
[[angles]]
over = "sand"
least = 150
angle_stiffness = 8
[study]
type = "energy"
)") + "'");
  INFO(answer.text);
  CHECK(answer.status == 0);
  // K = E t²/(2q₀) = 3, B = E t⁴/(12q₀) = 2, turned by 60° a particle; D = E t³/(12 (1 − 1/9)) = 2.25, Y = E t = 6
  for (const char* words : {"loop 'ring': 6 particles", "radius 2, chord 2\n", "bond stiffness K = 3, rest length q0 = 2, EA = 2 K q0 = 12",
                            "angle stiffness B = 2, at rest 120 degrees, EI = B q0 = 4", "sheet 'plate': 14 particles", "rectangle, 4 by 2; lattice at 0 degrees, spacing 1; 27 bonds of length 1 as built",
                            "Y = 4 K/sqrt(3) = 6, nu = 1/3", "straight at rest, D = 3 sqrt(3)/4 B = 2.25", "cylinder, radius 2, height 3", "where it closes, (13, 0) steps around",
                            "mass 9.424777961", "connection of 'ring' and 'plate' within 16.001: K = 5, 1 bond, rest length 16",
                            "connection of 'sand' and 'sand', each with its nearest 1: K = 7, 2 bonds, rest length 10", "bonds: 1 of a list, EA = 4",
                            "angles: over the bonds that meet in 'sand' at 150 degrees or more, B = 8", "\nand "})
    CHECK(answer.text.find(words) != std::string::npos);
  std::size_t named = 0;
  for (std::size_t at = 0; (at = answer.text.find("free rigid motion:", at)) != std::string::npos; ++at) ++named;
  CHECK(named == 10);
}

TEST_CASE("grains that nothing holds are named at the end of a run", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("grains.toml", R"(
[[grains]]
name = "sand"
positions = [[0, 0, 0.45], [5, 0, 3]]
diameter = 1
[[wall]]
name = "floor"
group = "sand"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
effective_modulus = 75
[study]
type = "equilibrium"
)");
  const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  CHECK(answer.status == 0);
  CHECK(answer.text.find("rattler: sand 2 touches nothing") != std::string::npos);
  const auto summary = nlohmann::json::parse(text_of(scratch / "out/summary.json"));
  CHECK(summary["zero_modes"].dump().find("rattler: sand 2 touches nothing") != std::string::npos);
}
