// Rigid bodies of a problem file: what they weigh, where they stand, what holds, loads and joins them.
#include "catch.hpp"

#include "laws/rounded/rotation.hpp"
#include "input/model_of.hpp"
#include "energy/kinematics.hpp"
#include "input/stages.hpp"

using namespace elamin;
using Catch::Matchers::WithinRel;

namespace {

std::string body(const std::string& name, const std::string& shape, const std::string& more = "") {
  return "[[body]]\nname = \"" + name + "\"\nshape = \"" + shape + "\"\n" + more;
}

/// A cube of edge 1, rounded by 0.1, on the x axis.
std::string cube(const std::string& name, double x, const std::string& more = "") {
  return body(name, "cube", "edge = 1\nrounding_diameter = 0.2\nposition = [" + std::to_string(x) + ", 0, 0]\n" + more);
}

/// Steiner: volume of a convex solid with a ball of radius ρ about each of its points, from its volume, surface and mean width · 2π.
double rounded_volume(double volume, double surface, double edges, double rho) {
  return volume + surface * rho + edges * rho * rho + 4 * pi / 3 * rho * rho * rho;
}

const double rounding = 1e-13;

}  // namespace

TEST_CASE("The mass of a body is its density times its volume, rounding included", "[problem][bodies]") {
  const double rho = 0.15;
  const std::string more = "rounding_diameter = 0.3\ndensity = 2.5\n";
  const double slope = std::acos(-1 / 3.0);                   // π minus the angle between the faces of a tetrahedron
  const std::tuple<std::string, std::string, double> solids[]{
      {"sphere", "", rounded_volume(0, 0, 0, rho)},
      {"rod", "length = 2\n", rounded_volume(0, 0, pi * 2, rho)},
      {"cube", "edge = 2\n", rounded_volume(8, 24, 12 * 2 * pi / 4, rho)},
      {"box", "size = [1, 2, 3]\n", rounded_volume(6, 22, 4 * 6 * pi / 4, rho)},
      {"tetrahedron", "edge = 2\n", rounded_volume(8 / (6 * std::sqrt(2.0)), 4 * std::sqrt(3.0), 6 * 2 * slope / 2, rho)},
      {"mesh", "vertices = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]]\n"
               "faces = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]]\n",
       rounded_volume(8, 24, 12 * 2 * pi / 4, rho)}};
  for (const auto& [shape, size, volume] : solids) {
    INFO(shape);
    const Model m = model_of(body("b", shape, size + more) + energy_study);
    REQUIRE(m.bodies.size() == 1);
    CHECK_THAT(m.bodies[0].mass, WithinRel(2.5 * volume, rounding));
    CHECK((m.bodies[0].inertia - m.bodies[0].inertia.transpose()).norm() == 0);
  }
}

TEST_CASE("With little rounding the inertia of a cube is that of a cube", "[problem][bodies]") {
  const double rho = 1e-9;                                    // its part in the inertia: 24 · 2 ρ/a at most
  const Model m = model_of(body("b", "cube", "edge = 2\nrounding_diameter = 2e-9\nmass = 3\n") + energy_study);
  CHECK(m.bodies[0].mass == 3);
  CHECK((m.bodies[0].inertia - 3 * 4 / 6.0 * Mat3::Identity()).norm() <= 100 * rho);
  CHECK(m.shapes[0].radius == rho);
}

TEST_CASE("A body stands where its core is put, and turns about its centre of mass", "[problem][bodies]") {
  const std::string mesh = "vertices = [[0, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 3]]\n"
                           "faces = [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]]\nrounding_diameter = 0.5\ndensity = 1\n";
  const Model m = model_of(body("b", "mesh", mesh + "position = [5, -6, 7]\nrotation = {axis = [0, 0, 3], angle = 90}\n") + energy_study);
  const Pose& pose = m.start.bodies[0];
  const Vec3 corners[]{{5, -6, 7}, {5, -4, 7}, {4, -6, 7}, {5, -6, 10}};
  for (int k = 0; k < 4; ++k) CHECK((pose.position.hi + pose.rotation * m.shapes[0].vertices[k] - corners[k]).norm() <= 1e-14);
  CHECK(mass_properties(m.shapes[0]).center.norm() <= 1e-14);
  CHECK(m.structures[0].kind == "body");
  CHECK((m.structures[0].first_body == 0 && m.structures[0].bodies == 1 && m.structures[0].count == 0));
}

TEST_CASE("A given inertia and a molecule file are taken as they are", "[problem][bodies]") {
  const Model m = model_of(body("b", "rod", "length = 2\nrounding_diameter = 1\nmass = 3\ninertia = [1, 4, 4.5, 0.25, 0.5, -0.125]\n") +
                           energy_study);
  Mat3 inertia;
  inertia << 1, 0.25, 0.5, 0.25, 4, -0.125, 0.5, -0.125, 4.5;
  CHECK(m.bodies[0].inertia == inertia);
  CHECK(m.start.bodies[0].position.hi == Vec3::Zero());
  const std::string file = std::string("molecule = \"") + ELAMIN_ROOT "/tests/input/good/body.mol\"\n";
  const Model of_file = model_of(body("b", "molecule", file + "mass = 2\nposition = [1, 2, 3]\n") + energy_study);
  CHECK(of_file.bodies[0].mass == 2);
  CHECK(of_file.bodies[0].inertia == Mat3(Vec3(0.25, 2, 2).asDiagonal()));
  CHECK(of_file.start.bodies[0].position.hi == Vec3(1, 2, 3));
  CHECK(of_file.shapes[0].vertices[1] == Vec3(1, 0, 0));
}

TEST_CASE("Bodies count on after particles, and groups hold both", "[problem][bodies]") {
  const Model m = model_of(cube("one", 0) + cube("two", 5) + cube("three", 10) + grains("g", "[[20, 0, 0], [30, 0, 0]]") +
                           "[[group]]\nname = \"last\"\nlast = 2\n[[group]]\nname = \"first\"\nfirst = 3\n"
                           "[[group]]\nname = \"chosen\"\nids = [5, 1, 3]\n[[group]]\nname = \"middle\"\nmiddle = 1\n"
                           "[[group]]\nname = \"near\"\ninside = {shape = \"sphere\", center = [0, 0, 0], radius = 7}\n"
                           "[[group]]\nname = \"far\"\noutside = {shape = \"sphere\", center = [0, 0, 0], radius = 7}\n" + energy_study);
  CHECK(m.id == std::vector{1, 2});
  for (int b = 0; b < 3; ++b) CHECK((m.bodies[b].id == 3 + b && m.bodies[b].type == 2 + b));
  const auto members = [&](const std::string& name) {
    for (const Group& g : m.groups)
      if (g.name == name) return std::pair(g.particles, g.bodies);
    return std::pair(std::vector{-1}, std::vector{-1});
  };
  using Lists = std::pair<std::vector<int>, std::vector<int>>;
  CHECK(members("all") == Lists{{0, 1}, {0, 1, 2}});
  CHECK(members("two") == Lists{{}, {1}});
  CHECK(members("last") == Lists{{}, {1, 2}});
  CHECK(members("first") == Lists{{0, 1}, {0}});
  CHECK(members("chosen") == Lists{{0}, {0, 2}});
  CHECK(members("middle") == Lists{{}, {0}});
  CHECK(members("near") == Lists{{}, {0, 1}});
  CHECK(members("far") == Lists{{0, 1}, {2}});
}

TEST_CASE("A support of bodies holds all six coordinates, or what it names", "[problem][bodies]") {
  const auto support = [](const std::string& keys, const std::string& plane = "") {
    return model_of(plane + cube("one", 0) + "[[support]]\ngroup = \"one\"\n" + keys + energy_study).supports[0];
  };
  using Three = std::array<bool, 3>;
  const Three all{true, true, true}, none{false, false, false};
  const Support s = support("");
  CHECK((s.bodies == std::vector{0} && s.held == all && s.constrained_rotations == all));
  CHECK((support("directions = \"xz\"\n").held == Three{true, false, true}));
  CHECK((support("directions = \"xz\"\n").constrained_rotations == none));
  CHECK((support("rotations = \"zy\"\n").held == none));
  CHECK((support("rotations = \"zy\"\n").constrained_rotations == Three{false, true, true}));
  CHECK((support("rotations = \"z\"\n", "plane = \"xy\"\n").constrained_rotations == Three{false, false, true}));
  const Support turned = support("rotation = {axis = [0, -2, 0], angle = 90}\n");
  CHECK((turned.rotation - Vec3(0, -pi / 2, 0)).norm() <= 1e-15);
  CHECK((turned.held == all && turned.constrained_rotations == all));
}

TEST_CASE("Loads, weights and velocities act on bodies", "[problem][bodies]") {
  const Model m = model_of(cube("one", 0, "density = 2\nrotation = {axis = [1, 0, 0], angle = 40}\n") + cube("two", 5, "mass = 3\n") +
                           grains("g", "[[20, 0, 0]]", "density = 1\n") +
                           "[[load]]\ngroup = \"all\"\ntotal_force = [0, 0, 6]\n"
                           "[[load]]\ngroup = \"two\"\nforce = [1, 0, 0]\npoint = [0, 0.5, 0]\ntorque = [0, 0, 2]\n"
                           "[[gravity]]\nacceleration = [0, 0, -10]\n[[viscosity]]\ncoefficient = 2\n"
                           "[[velocity]]\ngroup = \"one\"\nvelocity = [1, 2, 3]\nspin = [0.5, 0, -1]\n"
                           "[study]\ntype = \"dynamics\"\n[dynamics]\ntimestep = 1e-3\n");
  CHECK(m.loads[0].force == Vec3(0, 0, 2));
  CHECK(m.loads[0].bodies == std::vector{0, 1});
  CHECK((m.loads[1].point == Vec3(0, 0.5, 0) && m.loads[1].torque == Vec3(0, 0, 2) && m.loads[1].force == Vec3(1, 0, 0)));
  CHECK(m.gravity[0].bodies == std::vector{0, 1});
  CHECK(m.viscosity[0].bodies == std::vector{0, 1});
  CHECK((m.body_velocity.col(0) == Vec3(1, 2, 3) && m.body_velocity.col(1).isZero(0)));
  // A cube's inertia is the same about every axis.
  CHECK((m.angular_momentum.col(0) - m.bodies[0].inertia(0, 0) * Vec3(0.5, 0, -1)).norm() <= 1e-14 * m.bodies[0].inertia.norm());
  CHECK(m.velocity.isZero(0));
}

TEST_CASE("Tables of rounded contacts and walls of bodies", "[problem][bodies]") {
  const std::string wall = "[[wall]]\nname = \"floor\"\ngroup = \"one\"\nshape = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 2]\n"
                           "k_n = 20\nk_na = 0.5\ncutoff = 0.25\nc_n = 3\n";
  const std::string table = "[[contact]]\nbetween = [\"one\", \"all\"]\nlaw = \"rounded\"\nk_n = 10\nk_na = 2\ncutoff = 0.5\n";
  const Model m = model_of(cube("one", 0) + cube("two", 5) + grains("g", "[[20, 0, 0]]") + table + wall + energy_study);
  REQUIRE((m.rounded.size() == 1 && m.contacts.empty()));
  const RoundedPair& r = m.rounded[0];
  CHECK((r.bodies[0] == std::vector{0} && r.bodies[1] == std::vector{0, 1} && r.particles[0].empty() && r.particles[1] == std::vector{0}));
  CHECK((r.kernel.normal == 10 && r.kernel.attraction == 2 && r.kernel.cutoff == 0.5 && r.kernel.form == RoundedKernel::Form::coded));
  CHECK((r.formulation == RoundedFormulation::multi && r.unit_area == 1 && r.damping.friction == 0 && !r.damping.apart));
  const Wall& w = m.walls[0];
  CHECK((w.bodies == std::vector{0} && w.particles.empty() && !w.lammps && w.effective_modulus == 0));
  CHECK((w.kernel.normal == 20 && w.kernel.attraction == 0.5 && w.kernel.cutoff == 0.25));
  CHECK((w.body_damping.normal == 3 && w.body_damping.tangential == 1.5));
  const Model lammps = model_of(cube("one", 0) + cube("two", 5) + table + "formulation = \"lammps\"\ndelta_ua = 0.5\nmu = 0.25\n" +
                                wall.substr(0, wall.find("k_na")) +
                                "formulation = \"lammps\"\n" + energy_study);
  CHECK((lammps.rounded[0].formulation == RoundedFormulation::lammps && lammps.rounded[0].unit_area == 0.5 && lammps.walls[0].lammps));
}

TEST_CASE("A body carries what is glued to it", "[problem][bodies]") {
  const Model m = model_of(cube("one", 0, "rotation = {axis = [0, 0, 1], angle = 90}\n") + grains("g", "[[3, 0, 0], [0, 4, 0]]") +
                           "[[glue]]\ngroup = \"g\"\nbody = \"one\"\n[[support]]\ngroup = \"one\"\n[study]\ntype = \"equilibrium\"\n");
  REQUIRE(m.glued.size() == 2);
  CHECK((m.glued[0].particle == 0 && m.glued[1].particle == 1 && m.glued[1].body == 0));
  CHECK((m.glued[0].arm - Vec3(0, -3, 0)).norm() <= 1e-15);
  CHECK((m.glued[1].arm - Vec3(4, 0, 0)).norm() <= 1e-15);
}

TEST_CASE("A support of bodies that enters in a stage holds them where they are then", "[problem][bodies]") {
  const ScratchDirectory scratch;
  const std::string later = "[[support]]\nname = \"turn\"\ngroup = \"one\"\ndisplacement = [0, 0, 0.5]\nrotation = {axis = [1, 0, 0], angle = 60}\n"
                            "from_stage = \"b\"\n";
  const Problem p = read_problem(scratch.file("p.toml", cube("one", 0) + cube("two", 5) +
      "[[support]]\ngroup = \"two\"\n[[support]]\nname = \"still\"\ngroup = \"one\"\n" + later +
      "[[contact]]\nbetween = [\"all\", \"all\"]\nlaw = \"rounded\"\nk_n = 1\n[[contact]]\nbetween = [\"one\", \"two\"]\nlaw = \"rounded\"\nk_n = 2\n"
      "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, -9]\nnormal = [0, 0, 1]\nk_n = 1\nfrom_stage = \"b\"\n"
      "[path]\n[[stage]]\nname = \"a\"\nfrom = 0\nto = 1\n[[stage]]\nname = \"b\"\noff = [\"support.still\", \"contact.1\"]\nfrom = 0\nto = 1\n"));
  Model all = build_model(p);
  Stages stages(p);
  std::string unclear;
  const Model a = model_in(p, stages.enter(unclear), all, all.start);
  CHECK((a.supports.size() == 2 && a.rounded.size() == 2 && a.walls[0].bodies.empty()));
  stages.leave(1);
  State now = all.start;
  now.bodies[0] = moved(now.bodies[0], Vec3(0.25, 0, 0), Vec3(0, 0, 0.3));
  const Model b = model_in(p, stages.enter(unclear), all, now);
  REQUIRE((b.supports.size() == 2 && b.rounded.size() == 1 && b.rounded[0].kernel.normal == 2 && b.walls[0].bodies.size() == 2));
  REQUIRE(b.supports[1].body_reference.size() == 1);
  // Held where it is at the beginning of the stage, turned by the whole rotation at its end.
  const Kinematics kinematics(b);
  State begin = now, end = now;
  kinematics.prescribe(begin, 0), kinematics.prescribe(end, 1);
  CHECK(kinematics.displacement(now, begin).norm() <= 1e-15);
  CHECK((kinematics.displacement(now, end).col(kinematics.place_of(0)) - Vec3(0, 0, 0.5)).norm() <= 1e-15);
  CHECK((rotation_between(now.bodies[0].rotation, end.bodies[0].rotation) - Vec3(pi / 3, 0, 0)).norm() <= 1e-14);
}

TEST_CASE("A setting reaches a body's sizes", "[problem][bodies]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", cube("one", 0) + energy_study);
  const Model m = build_model(read_problem(file, {{"body.one.edge", "2"}, {"body.one.position.1", "0.5"}}));
  CHECK(m.shapes[0].shortest_edge == 2);
  CHECK(m.start.bodies[0].position.hi == Vec3(0.5, 0, 0));
}
