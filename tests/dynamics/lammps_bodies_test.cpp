// LAMMPS's rules for whole models.
#include "dynamics/lammps_bodies.hpp"

#include "catch.hpp"
#include "dynamics/body_case.hpp"

using namespace elamin;

namespace {

Wrenches wrenches(const LammpsBodyForces& found) {
  Wrenches w(found.on.size());
  w.energy = found.energy;
  for (std::size_t k = 0; k < found.on.size(); ++k) w.forces[k] = found.on[k].force, w.torques[k] = found.on[k].torque;
  return w;
}

}  // namespace

TEST_CASE("models feel what LAMMPS's rules say", "[dynamics][bodies][lammps]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    const Model m = model_of_bodies(c);
    REQUIRE(follows_lammps(m));
    const LammpsBodyForces found = lammps_body_forces(m, m.start, {Field(), m.body_velocity, m.angular_momentum});
    CHECK(wrenches(found).off(c.expected["lammps"]) <= 1e-12);
    CHECK(found.walls == static_cast<int>(m.walls.size()));
    CHECK(found.overflow.empty());
    if (c.name == "core_overlap") CHECK(found.through == std::vector<IndexPair>{{0, 1}});
    if (c.name == "ff_box_box_scaled") CHECK(found.not_conservative == std::vector<IndexPair>{{0, 1}});
    if (c.name == "vf_box_box_overlap") CHECK(found.not_conservative.empty());
  }
}

TEST_CASE("LAMMPS's rules take a particle for a sphere", "[dynamics][bodies][lammps]") {
  for (const std::string name : {"vf_sphere_box_overlap", "ve_sphere_rod", "vf_ve_sphere_box_twice"}) {
    const ReferenceCase c = reference_case(name);
    INFO(name);
    Model m = model_of_bodies(c);
    const int s = m.shapes[0].vertices.size() == 1 ? 0 : 1, other = 1 - s;
    m.start = State(Field(m.start.bodies[s].position.hi));
    m.start.bodies = {{{c.bodies[other].x, Vec3::Zero()}, Eigen::Quaterniond::Identity()}};
    m.diameter = {2 * c.bodies[s].radius}, m.density = {1}, m.id = {s + 1}, m.type = {1}, m.molecule = {1};
    m.bodies = {m.bodies[other]};
    const RoundedKernel kernel = c.kernel(0, 1);
    m.rounded.resize(1);
    m.rounded[0].particles = {std::vector{0}, std::vector<int>{}}, m.rounded[0].bodies = {std::vector<int>{}, std::vector{0}};
    m.rounded[0].kernel = kernel;
    const LammpsBodyForces found = lammps_body_forces(m, m.start);
    const nlohmann::json& expected = c.expected["lammps"];
    CHECK(found.pairs == 1);
    CHECK(found.energy == Approx(expected["energy"].get<double>()).epsilon(1e-12));
    CHECK((found.on_particles.col(0) - vector_of(expected["forces"][s])).norm() <= 1e-12);
    CHECK((found.on[0].force - vector_of(expected["forces"][other])).norm() <= 1e-12);
    CHECK((found.on[0].torque - vector_of(expected["torques"][other])).norm() <= 1e-12);
    CHECK(found.on_particles.col(0).norm() > 0.1);
  }
}

TEST_CASE("planes across axes and blocks are LAMMPS's walls", "[dynamics][bodies][lammps]") {
  Wall wall;
  wall.kernel.normal = 5, wall.body_damping = {2, 1}, wall.displacement = Vec3(0, 0, 1);
  wall.region.shape = Shape::plane, wall.region.center = Vec3(1, 2, 3), wall.region.normal = -Vec3::UnitZ();
  std::vector<LammpsWall> walls = lammps_walls(wall, 0.5);
  REQUIRE(walls.size() == 1);
  CHECK(walls[0].axis == 2);
  CHECK(walls[0].hi == 3.5);
  CHECK(!std::isfinite(walls[0].lo));
  CHECK(walls[0].stiffness == 5);
  CHECK(walls[0].normal_damping == 2);
  CHECK(walls[0].tangential_damping == 1);
  wall.inside = false;
  CHECK(lammps_walls(wall, 0.5)[0].lo == 3.5);
  wall.inside = true, wall.region.shape = Shape::block, wall.region.lo = Vec3(0, 0, 0), wall.region.hi = Vec3(1, 2, 3);
  wall.region.open[2] = wall.region.open[3] = wall.region.open[5] = true;
  walls = lammps_walls(wall, 0);
  REQUIRE(walls.size() == 2);
  CHECK(walls[0].axis == 0);
  CHECK(walls[0].hi == 1);
  CHECK(walls[1].lo == 0);
  CHECK(!std::isfinite(walls[1].hi));
}
