// Sheets under a pressure that follows them.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "input/model_of.hpp"
#include "model/sheet.hpp"
#include "solve/method.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>

using namespace elamin;

namespace {

const std::string disc = R"(
[[sheet]]
name = "disc"
shape = "circle"
radius = 4
center = [0.5, -1, 2]
spacing = 1
thickness = 0.1
youngs_modulus = 1
[[group]]
name = "rim"
of = "disc"
outside = {shape = "cylinder", center = [0.5, -1], axis = "z", radius = 2.5}
[[support]]
group = "rim"
[[pressure]]
sheet = "disc"
pressure = 0.01
[study]
type = "equilibrium"
)";

/// −∂E/∂x of the pressures, from a model that has nothing else.
Field forces_of_pressure(Model m, const State& state) {
  m.bonds.clear(), m.angles.clear();
  Energy energy(m);
  return energy.forces(state);
}

}  // namespace

TEST_CASE("a flat sheet bears a third of the pressure on the triangles around each particle, the rim too", "[energy]") {
  const Model m = model_of(disc);
  const Pressure& p = m.pressures.at(0);
  State state = m.start;
  state.load_factor = 1;
  const Field force = forces_of_pressure(m, state);
  std::vector<int> around(m.particles());
  for (const auto& t : p.triangles)
    for (const int i : t) ++around[i];
  REQUIRE(p.triangles.size() > 50);
  const double share = 0.01 * std::sqrt(3) / 4 / 3;
  for (int i = 0; i < m.particles(); ++i) CHECK((force.col(i) - Vec3(0, 0, -share * around[i])).norm() < 1e-14);
}

TEST_CASE("on a bent sheet the pressure is normal to the triangles, wherever the tip is", "[energy]") {
  Model m = model_of(disc);
  State state = m.start;
  state.load_factor = 1;
  const auto held = [&](int i) { return std::binary_search(m.supports[0].particles.begin(), m.supports[0].particles.end(), i); };
  for (int i = 0; i < m.particles(); ++i)
    if (!held(i)) state.position.col(i) += Vec3(0.1 * std::sin(3.0 * i), 0.1 * std::cos(5.0 * i), 0.3 * std::sin(7.0 * i));
  Field expected = Field::Zero(3, m.particles());
  for (const auto& [i, j, k] : m.pressures[0].triangles) {
    const Vec3 area = (state.position.col(j) - state.position.col(i)).cross(Vec3(state.position.col(k) - state.position.col(i))) / 2;
    for (const int p : {i, j, k}) expected.col(p) -= 0.01 / 3 * area;
  }
  for (const Vec3& tip : {m.pressures[0].tip, Vec3(7, 8, 9)}) {
    m.pressures[0].tip = tip;
    const Field force = forces_of_pressure(m, state);
    for (int i = 0; i < m.particles(); ++i)
      if (!held(i)) CHECK((force.col(i) - expected.col(i)).norm() < 1e-14);
  }
}

TEST_CASE("a tube's pressure comes from outside, its rims are its ends", "[energy]") {
  const Model m = model_of(R"(
[[sheet]]
name = "tube"
shape = "cylinder"
radius = 3
height = 6
spacing = 1
thickness = 0.1
youngs_modulus = 1
[[support]]
group = "tube"
[[pressure]]
sheet = "tube"
pressure = 2
[study]
type = "energy"
)");
  const Pressure& p = m.pressures.at(0);
  State state = m.start;
  state.load_factor = 1;
  const Field force = forces_of_pressure(m, state);
  double inwards = 0, along = 0;
  for (int i = 0; i < m.particles(); ++i) {
    const Vec3 x = state.position.col(i);
    inwards -= force.col(i).dot(Vec3(x.x(), x.y(), 0)) / 3;
    along += std::abs(force(2, i));
  }
  // Every triangle pushes p times its area along its own normal, which leans against the radius of its corners.
  double expected = 0;
  for (const auto& [i, j, k] : p.triangles) {
    const Vec3 area = (state.position.col(j) - state.position.col(i)).cross(Vec3(state.position.col(k) - state.position.col(i))) / 2;
    for (const int q : {i, j, k}) expected += 2.0 / 3 * area.dot(Vec3(state.position(0, q), state.position(1, q), 0)) / 3;
  }
  CHECK(expected > 0);
  CHECK(inwards == Approx(expected).epsilon(1e-12));
  CHECK(along < 0.02 * inwards);
}

TEST_CASE("the volume's second derivative is the Hessian", "[energy]") {
  Model m = model_of(disc);
  m.bonds.clear(), m.angles.clear();
  Energy energy(m);
  State state = m.start;
  state.load_factor = 1;
  energy.evaluate(state);
  Vector step(energy.dofs());
  for (int d = 0; d < step.size(); ++d) step[d] = 1e-3 * std::sin(1.7 * d);
  const Vector g = energy.gradient(), hs = energy.multiply(step, false);
  state.position += energy.kinematics().extend(step);
  energy.evaluate(state);
  // The energy is of third order: with the mean of the Hessians at both ends the difference of gradients is exact.
  CHECK((energy.gradient() - g - (hs + energy.multiply(step, false)) / 2).norm() < 1e-15);
  CHECK(hs.norm() > 1e-6);
}

TEST_CASE("under a small pressure a clamped plate gives way as its Hessian at rest tells", "[energy]") {
  Model m = model_of(disc);
  m.pressures[0].pressure = 1e-10;
  Energy energy(m);
  State state = m.start;
  state.load_factor = 1;
  energy.evaluate(state);
  const SparseMatrix h = energy.hessian();
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> factor(h);
  const Vector linear = factor.solve(-energy.gradient());
  Newton newton(energy);
  REQUIRE(minimise(newton, state, NewtonOptions{}).status == Status::converged);
  const Field expected = energy.kinematics().extend(linear), moved = state.position - m.start.position;
  CHECK(moved.row(2).minCoeff() < -1e-9);
  CHECK((moved - expected).norm() < 1e-6 * moved.norm());    // membrane forces are (w/t)² of it
}
