// What the load factor scales, and the conditions that are more than a vector.
#include "catch.hpp"
#include "model_of.hpp"
#include "input/conditions.hpp"
#include "input/settings.hpp"
#include "study/prepare.hpp"

using namespace elamin;

namespace {

const std::string held_ring =
    "plane = \"xy\"\n[[loop]]\nname = \"ring\"\nparticles = 12\ncenter = [5, 3, 0]\nradius = 2\ndiameter = 1\nyoungs_modulus = 1\n"
    "[[group]]\nname = \"two\"\nof = \"ring\"\nfirst = 2\n[[support]]\nname = \"hand\"\ngroup = \"two\"\ndisplacement = [1, 0, 0]\n"
    "[[load]]\ngroup = \"ring\"\nradial = -0.5\n[[load]]\nname = \"push\"\ngroup = \"ring\"\nforce = [1, 0, 0]\nconstant = true\n"
    "[[gravity]]\nacceleration = [0, 0, 0]\n[[pressure]]\nloop = \"ring\"\npressure = 3\n"
    "[[change]]\nname = \"growth\"\ngroup = \"ring\"\nrest_length = 0.25\n"
    "[[wall]]\nname = \"pipe\"\nshape = \"cylinder\"\ncenter = [5, 3]\naxis = \"z\"\nradius = 9\neffective_modulus = 1\n";

std::string dense(std::string text) { return text.insert(text.find("youngs"), "density = 1\n"); }

std::vector<Scaling> scalings(const std::string& path) {
  const Model model = model_of(dense(held_ring) + path);
  return scalings_in(model);
}

}  // namespace

TEST_CASE("The load factor scales what is not constant, or what is chosen") {
  const Scaling s, c = Scaling::constant();
  // In this order: support, two loads, gravity, pressure, change, wall.
  CHECK(scalings("") == std::vector{s, s, c, c, s, s, s});
  CHECK(scalings("[path]\nparameter = \"load.1\"") == std::vector{c, s, c, c, c, c, c});
  CHECK(scalings("[path]\nparameter = [\"load.2\", \"gravity.1\"]") == std::vector{c, c, s, s, c, c, c});
  CHECK(scalings("[path]\nparameter = [\"load.push\", \"support.hand\"]") == std::vector{s, c, s, c, c, c, c});
  CHECK(scalings("[path]\nparameter = [\"support.1\", \"wall.pipe\", \"change.growth\", \"pressure.1\"]") ==
        std::vector{s, c, c, c, s, s, s});
}

TEST_CASE("A radial load points away from the axis where it is built") {
  const Model m = model_of(dense(held_ring));
  REQUIRE(m.loads[0].own.cols() == 12);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 12; ++i) {
    const Vec3 out = (m.start.position.col(i) - Vec3(5, 3, 0)).normalized();
    CHECK((m.loads[0].on(i) + 0.5 * out).norm() <= 1e-15);
    sum += m.loads[0].on(i);
  }
  CHECK(sum.norm() <= 1e-15);
  CHECK(m.loads[1].on(3) == Vec3(1, 0, 0));
  // About another axis: along y through the origin, away from it in x and z.
  std::string other = dense(held_ring).substr(std::string("plane = \"xy\"\n").size());
  other.replace(other.find("radial = -0.5"), 13, "radial = 2\naxis = [0, 3, 0]\ncenter = [0, 0, 0]");
  const Model n = model_of(other);
  for (int i = 0; i < 12; ++i) CHECK((n.loads[0].on(i) - Vec3(2, 0, 0)).norm() <= 1e-15);
}

TEST_CASE("A pressure goes round its loop, a change has the group's particles") {
  const Model m = model_of(dense(held_ring));
  REQUIRE(m.pressures.size() == 1);
  CHECK(m.pressures[0].particles == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  CHECK(m.pressures[0].normal == Vec3(0, 0, 1));
  CHECK(m.pressures[0].pressure == 3);
  REQUIRE(m.changes.size() == 1);
  CHECK(m.changes[0].rest_length == 0.25);
  CHECK(m.changes[0].bond_stiffness == 0);
  CHECK(m.changes[0].particles.size() == 12);
}

TEST_CASE("Settings reach conditions by name and by number") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", dense(held_ring) + "[path]\n");
  const Problem p = read_problem(file, {{"support.hand.displacement", "[2, 0, 0]"},
                                        {"load.1.radial", "-0.75"},
                                        {"pressure.1.pressure", "4"},
                                        {"change.growth.rest_length", "0.5"},
                                        {"path.parameter", "\"pressure.1\""}});
  CHECK(p.supports[0].displacement == Vec3(2, 0, 0));
  CHECK(p.loads[0].radial == -0.75);
  CHECK(p.pressures[0].pressure == 4);
  CHECK(p.changes[0].rest_length == 0.5);
  CHECK(p.path.parameter == std::vector<std::string>{"pressure.1"});
}

TEST_CASE("A wall that does not vary stands where it is at last") {
  std::string text = dense(held_ring);
  text += "radius_change = -4\n[path]\nto = 2\n";
  CHECK(said_of(text + "parameter = \"load.1\"") == "");                 // 5 at every load factor
  text.replace(text.find("radius_change = -4"), 18, "radius_change = -5");
  CHECK(said_of(text + "parameter = \"load.1\"") == "");
  CHECK(said_of(text).find("wall.pipe.radius_change: makes a radius -1 at load factor 2") != std::string::npos);
}
