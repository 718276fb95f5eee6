// ∂g/∂λ of everything that the load factor scales, each kind alone and beside parts that stay.
#include "catch.hpp"
#include "chain.hpp"
#include "energy/load_difference.hpp"
#include "laws/check_law.hpp"
#include "model/loop.hpp"

using namespace elamin;

namespace {

// A closed ring of twelve particles, one of them held.
Model ring() {
  Model m;
  add_loops(m, {{"ring", 12, Vec3(0.3, -0.2, 0.1), Vec3(0, 0, 1), 2.0, 1.1, 1, 1, {40, chord(2.0, 12)}, {0.7, pi}}});
  hold(m, 0, 0);
  return m;
}

State at_load(const Energy& energy, const State& state, double load_factor) {
  State moved = state;
  energy.kinematics().prescribe(moved, load_factor);
  return moved;
}

// Gradient, Hessian, their products and ∂g/∂λ at a bent state, against differences of the energy and of the gradient.
void check_derivatives(const Model& model, double size = 0.1) {
  const double load_factor = 0.7;
  Energy energy(model);
  const State state = bent(energy, load_factor, size);
  energy.evaluate(state);
  const Vector g = energy.gradient(), exact = energy.load_derivative();
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  const double scale = H.norm();
  Vector v(energy.dofs());
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = std::cos(2.3 * static_cast<double>(k));
  CHECK((energy.multiply(v) - H * v).norm() <= 64 * epsilon * scale * v.norm());
  CHECK(std::abs(energy.quadratic_form(v) - v.dot(H * v)) <= 64 * epsilon * scale * v.squaredNorm());
  const auto along = [&](double s) {
    State moved = state;
    energy.kinematics().retract(moved, v, s);
    return moved;
  };
  const double slope = difference([&](double s) { return energy.value(along(s)); }, difference_step);
  CHECK(std::abs(slope - g.dot(v)) <= difference_error * scale * v.norm());
  const Vector turn = difference([&](double s) -> Vector { energy.evaluate(along(s), false); return energy.gradient(); }, difference_step);
  CHECK((turn - H * v).norm() <= difference_error * scale * v.norm());
  const Vector differences = difference([&](double s) -> Vector {
    energy.evaluate(at_load(energy, state, load_factor + s), false);
    return energy.gradient();
  }, difference_step);
  CHECK(exact.norm() > 1e-4 * scale);
  CHECK((exact - differences).norm() <= difference_error * (scale + exact.norm()));
}

const Scaling partly{0.4, -0.6};                              // s(λ) = 0.4 − 0.6 λ

Change growth(const Scaling& scaling, double rest, double bond, double angle) {
  return {"", {1, 2, 3, 4, 5, 6, 7}, rest, bond, angle, scaling};
}

}  // namespace

TEST_CASE("a scaling is a fixed part and a rate", "[model]") {
  CHECK(Scaling().at(0.3) == 0.3);
  CHECK(Scaling::constant().at(0.3) == 1);
  CHECK(Scaling(0.25, 0.5).at(0.5) == 0.5);
  CHECK(Scaling(0, 1) == Scaling());
}

TEST_CASE("∂g/∂λ of dead loads and weights", "[energy]") {
  for (const Scaling& s : {Scaling(), partly}) {
    Model m = ring();
    m.loads.push_back({"", {3, 4}, Vec3(1, -2, 3), s});
    check_derivatives(m);
    m.loads[0].own = (Field(3, 2) << 1, 2, 3, -1, 0.5, 2).finished();
    check_derivatives(m);
    m.loads.push_back({"", {3, 5}, Vec3(5, 0, 1), Scaling::constant()});
    check_derivatives(m);
    Model heavy = ring();
    heavy.gravity.push_back({"", {2, 3, 4}, Vec3(3, 0, -9), s});
    check_derivatives(heavy);
  }
}

TEST_CASE("a load has a force of its own on every particle besides the common one", "[energy]") {
  Model m = ring();
  m.loads.push_back({"", {3, 5}, Vec3(1, 0, 0), Scaling(0.5, 2), (Field(3, 2) << 0, 0, 1, 2, 0, 0).finished()});
  Energy energy(m);
  const State state = at_load(energy, m.start, 0.25);
  Model free = ring();
  const Field without = Energy(free).forces(state), with = energy.forces(state);
  Field loads = Field::Zero(3, 12);
  loads.col(3) = Vec3(1, 1, 0), loads.col(5) = Vec3(1, 2, 0);   // s(0.25) = 1
  CHECK((with - without - loads).norm() <= 16 * epsilon * energy.force_scale());
}

TEST_CASE("∂g/∂λ of driven supports", "[energy]") {
  for (const Scaling& s : {Scaling(), partly}) {
    Model m = ring();
    hold(m, 5, 6, {true, false, true}, Vec3(-0.2, 0, 0.3));
    m.supports.back().scaling = s;
    check_derivatives(m);
    hold(m, 9, 9, {true, true, true}, Vec3(0.1, 0.1, 0));
    m.supports.back().scaling = Scaling::constant();
    check_derivatives(m);
  }
}

TEST_CASE("∂g/∂λ of walls that move and grow", "[energy]") {
  for (const bool radius : {false, true})
    for (const Scaling& s : {Scaling(), partly}) {
      Model m = ring();
      Wall w;
      w.name = "tube", w.region.shape = Shape::cylinder, w.region.axis = 2, w.region.radius = 2.3;
      w.region.center = Vec3(0.3, -0.2, 0);
      for (int p = 0; p < 12; ++p) w.particles.push_back(p);
      w.effective_modulus = 5, w.scaling = s;
      (radius ? w.radius_change : w.displacement[0]) = -0.15;        // every particle stays between its centre and its surface
      m.walls.push_back(w);
      check_derivatives(m, 0.05);
      if (radius) {
        m.walls[0].displacement = Vec3(0.05, -0.1, 0);
        check_derivatives(m, 0.05);
      }
    }
}

TEST_CASE("∂g/∂λ of rest lengths and stiffnesses", "[energy]") {
  for (const Scaling& s : {Scaling(), Scaling(0.4, -0.6)}) {
    Model rest = ring(), bond = ring(), angle = ring(), all = ring();
    rest.changes = {growth(s, 0.3, 0, 0)};
    bond.changes = {growth(s, 0, -0.4, 0)};
    angle.changes = {growth(s, 0, 0, 5)};
    all.changes = {growth(s, 0.3, -0.4, 5), growth(Scaling::constant(), -0.1, 0.2, 0.3), growth(Scaling(), 0.05, 0, 0)};
    all.changes[1].particles = {5, 6, 7, 8, 9}, all.changes[2].particles = {6, 7, 8};
    for (const Model& m : {rest, bond, angle, all}) check_derivatives(m);
  }
}

TEST_CASE("changes scale what they name by 1 + s(λ) c, and add up", "[energy]") {
  const double lambda = 0.5;
  Model m = ring(), same = ring();
  m.changes = {growth(Scaling(), 0.25, -0.5, 1), growth(Scaling::constant(), 0.125, 0, 0)};
  m.changes[1].particles = {6, 7, 8};
  // The same by hand: new types for the bonds 1–2 … 6–7, for 6–7 and 7–8 another rest length, and the angles among 1 … 7.
  const BondType bond = same.bond_types[0];
  same.bond_types.push_back({bond.stiffness * 0.75, bond.rest_length * 1.125});
  same.bond_types.push_back({bond.stiffness * 0.75, bond.rest_length * 1.25});
  same.bond_types.push_back({bond.stiffness, bond.rest_length * 1.125});
  same.angle_types.push_back({same.angle_types[0].stiffness * 1.5, pi});
  int changed = 0;
  for (Bond& b : same.bonds) {
    const auto [i, j] = std::minmax(b.particles[0], b.particles[1]);
    if (j != i + 1 || i < 1 || i > 7) continue;
    b.type = i < 6 ? 1 : i == 6 ? 2 : 3;
    ++changed;
  }
  CHECK(changed == 7);
  for (Angle& a : same.angles) {
    const auto [least, most] = std::minmax({a.particles[0], a.particles[1], a.particles[2]});
    if (least >= 1 && most <= 7) a.type = 1;
  }
  Energy energy(m), by_hand(same);
  const State state = bent(energy, lambda);
  energy.evaluate(state), by_hand.evaluate(state);
  CHECK(energy.last_terms().bond == by_hand.last_terms().bond);
  CHECK(energy.last_terms().angle == by_hand.last_terms().angle);
  CHECK((energy.gradient() - by_hand.gradient()).norm() <= 16 * epsilon * energy.force_scale());
  CHECK(energy.last_terms().bond != Energy(ring()).terms(state).bond);
}

TEST_CASE("∂g/∂λ of a pressure, in its plane and out of it", "[energy]") {
  for (const Scaling& s : {Scaling(), partly})
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(Vec3(0.3, 0.2, 0.9).normalized())}) {
      Model m = ring();
      m.pressures.push_back({"ring", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, n, 3, s});
      check_derivatives(m);
      m.pressures.push_back({"ring", m.pressures[0].particles, n, -1, Scaling::constant()});
      check_derivatives(m);
    }
}

TEST_CASE("∂g/∂λ of all of them at once", "[energy]") {
  Model m = ring();
  m.loads.push_back({"", {3, 4}, Vec3(1, -2, 3), Scaling()});
  m.gravity.push_back({"", {2, 3, 4}, Vec3(3, 0, -9), partly});
  hold(m, 8, 8, {true, false, true}, Vec3(-0.2, 0, 0.3));
  m.changes = {growth(Scaling(), 0.3, -0.4, 5)};
  m.pressures.push_back({"ring", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, Vec3::UnitZ(), 3, Scaling()});
  check_derivatives(m);
}

TEST_CASE("the force that the load factor scales is that of loads, weights and pressures only", "[energy]") {
  Model none = ring();
  none.changes = {growth(Scaling(), 0.3, -0.4, 5)};
  none.loads.push_back({"", {3, 4}, Vec3(1, -2, 3), Scaling::constant()});
  none.pressures.push_back({"ring", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, Vec3::UnitZ(), 3, Scaling::constant()});
  Energy without(none);
  CHECK_FALSE(without.loads_scaled());
  without.evaluate(bent(without, 0.7));
  CHECK(without.load_force().norm() == 0);
  CHECK(without.load_derivative().norm() > 0);

  Model some = none;
  some.loads.push_back({"", {5}, Vec3(0, 1, 0), Scaling()});
  some.pressures.push_back({"ring", some.pressures[0].particles, Vec3::UnitZ(), 2, Scaling()});
  Energy with(some);
  CHECK(with.loads_scaled());
  with.evaluate(bent(with, 0.7));
  // What they add to ∂g/∂λ is all of it.
  CHECK((with.load_force() + with.load_derivative() - without.load_derivative()).norm() <= 64 * epsilon * with.force_scale());
  CHECK(with.load_force().norm() > 1);
  some.loads.pop_back();
  CHECK(Energy(some).loads_scaled());
  some.pressures.back().pressure = 0;
  CHECK_FALSE(Energy(some).loads_scaled());
}
