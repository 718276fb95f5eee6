#include "catch.hpp"
#include "chain.hpp"
#include "core/dense.hpp"
#include "dynamics/timestep.hpp"
#include "dynamics/verlet.hpp"


using namespace elamin;

namespace {

double largest_frequency(Energy& energy, const State& state) {
  energy.evaluate(state, true);
  Eigen::MatrixXd K = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  Vector m(energy.dofs());
  for (int d = 0; d < energy.dofs(); ++d) m[d] = energy.model().mass(energy.kinematics().site_of(d));
  const Vector scale = m.cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  return std::sqrt(symmetric_eigen(K).values.tail<1>()[0]);
}

bool stays(const Model& m, double dt) {
  Verlet verlet(m, begin_motion(m), dt);
  verlet.advance(20000);
  return verlet.finite() && (verlet.motion().state.position - m.start.position).cwiseAbs().maxCoeff() < 0.1;
}

}  // namespace

TEST_CASE("the largest frequency is met from above within one per cent", "[dynamics]") {
  for (const int n : {3, 10, 60}) {
    Model m = chain(n, 100, 20, 1);
    for (int p = 0; p < n; ++p) m.density[p] = 1 + p % 3, m.start.position(0, p) += 0.01 * (p % 4);
    hold(m, 0, 0);
    Energy energy(m);
    const double w = largest_frequency(energy, m.start);
    const TimestepLimit limit = timestep_limit(energy, m.start);
    CHECK(limit.frequency >= w);
    CHECK(limit.frequency <= 1.01 * w);
    CHECK(limit.stable == Approx(2 / limit.frequency));
  }
}

TEST_CASE("a step just below the limit stays, one above does not", "[dynamics]") {
  Model m = chain(10, 100, 1, 1);
  hold(m, 0, 0), hold(m, 9, 9);
  for (int p = 1; p < 9; ++p) m.start.position(2, p) += 1e-9 * (p % 2 ? 1 : -1);
  for (const double drag : {0.0, 5.0}) {
    m.viscosity = {{{1, 2, 3, 4, 5, 6, 7, 8}, drag}};
    Energy energy(m);
    const TimestepLimit limit = timestep_limit(energy, m.start);
    CHECK(limit.drag == Approx(drag / m.mass(1)));
    CHECK(unstable(limit, 0.999 * limit.stable).empty());
    CHECK(unstable(limit, 1.001 * limit.stable).find("unstable") != std::string::npos);
    CHECK(stays(m, 0.99 * limit.stable));
    CHECK(!stays(m, 1.03 * limit.stable));
  }
}

TEST_CASE("nothing stiff has no limit", "[dynamics]") {
  Model m;
  m.start = State(Field(Field::Zero(3, 1)));
  m.diameter = {1}, m.density = {1}, m.id = {1}, m.type = {1}, m.molecule = {1};
  Energy energy(m);
  CHECK(std::isinf(timestep_limit(energy, m.start).stable));
  CHECK(unstable(timestep_limit(energy, m.start), 1e9).empty());
}

TEST_CASE("the longest step of bodies: a rod that touches, a ball that a body carries", "[dynamics][bodies]") {
  // A ball of mass m over a floor of stiffness k: ω = √(k/m). A box held in its place that carries a particle held by a bond of stiffness
  // 2K at arm a: ω = √(2K a²/I), I with the ball.
  Model m = chain(2, 40, 1, 1);
  m.angles.clear();
  m.shapes = {rounded_shape(box_core(Vec3(0.5, 0.4, 0.3)), 0.1), rounded_shape(point_core(), 0.5)};
  m.bodies = {{0, 3, 1, 0.7, Vec3(0.05, 0.06, 0.07).asDiagonal()}, {1, 4, 1, 2.0, 0.1 * Mat3::Identity()}};
  m.start.bodies = {{{Vec3(-1.2, 0, 0), Vec3::Zero()}, Eigen::Quaterniond::Identity()},
                    {{Vec3(5, 0, 0.45), Vec3::Zero()}, Eigen::Quaterniond::Identity()}};
  m.glued = {{0, 0, Vec3(1.2, 0, 0)}};
  hold(m, 1, 1);
  Support s;
  s.bodies = {0};
  m.supports.push_back(s);
  Wall floor;
  floor.region.shape = Shape::plane, floor.bodies = {1}, floor.kernel.normal = 30;
  const bool lammps = GENERATE(false, true);
  floor.lammps = lammps;
  m.walls.push_back(floor);
  const double I = 0.06 + m.mass(0) * 1.44 + 0.1 * m.mass(0), carried = std::sqrt(2 * 40 * 1.44 / I), pressed = std::sqrt(30 / 2.0);
  CHECK(carried > pressed);
  Energy energy(m);
  CHECK(timestep_limit(energy, m.start).frequency == Approx(carried).epsilon(0.01));
  m.bodies[1].mass = 0.05;
  Energy light(m);
  CHECK(timestep_limit(light, m.start).frequency == Approx(std::sqrt(30 / 0.05)).epsilon(0.01));
  m.walls[0].body_damping.normal = 4;
  Energy damped(m);
  const TimestepLimit limit = timestep_limit(damped, m.start);
  const double yields = 1 / 0.05 + 0.45 * 0.45 / 0.1;                // of the point that touches, across the normal
  CHECK(limit.drag == Approx(4 * yields).epsilon(1e-9));
  m.viscosity.push_back({{}, 1, {1}});
  Energy dragged(m);
  CHECK(timestep_limit(dragged, m.start).drag == Approx(4 * yields + 1 / 0.05).epsilon(1e-9));
}
