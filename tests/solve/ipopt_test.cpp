#include "catch.hpp"
#include "chain.hpp"
#include "core/interrupt.hpp"
#include "model/grains.hpp"
#include "plate.hpp"
#include "solve/method.hpp"

#include <numeric>
#include <random>

using namespace elamin;

namespace {

void bow(Energy& energy, State& state, double by) {
  const double length = state.position.row(2).maxCoeff();
  Vector v = Vector::Zero(energy.dofs());
  for (int d = 0; d < v.size(); ++d)
    if (energy.kinematics().coordinate_of(d) == 0) v[d] = by * std::sin(pi * state.position(2, energy.kinematics().site_of(d)) / length);
  energy.kinematics().retract(state, v);
}

// Ipopt and Newton's method from the same state end at the same one: energies to 1e-12, places to 1e-7 of the extent. Of a symmetric structure
// Ipopt, which keeps to no valley, may find the mirror image in x; then `mirror` says so.
Report compare(const Model& model, Energy& energy, const State& start, bool mirror = false) {
  State by_newton = start, by_ipopt = start;
  Newton newton(energy);
  const Report expected = newton.minimise(by_newton);
  INFO(expected.why);
  REQUIRE(expected.converged());
  const Report report = minimise(newton, by_ipopt, IpoptOptions{});
  INFO(report.why << ", " << report.iterations << " iterations");
  REQUIRE(report.converged());
  CHECK(report.negative == 0);
  CHECK(report.residual <= 1e-10);
  CHECK(std::abs(report.energy - expected.energy) <= 1e-12 * energy.terms(by_newton).size());
  const double extent = (model.start.position.rowwise().maxCoeff() - model.start.position.rowwise().minCoeff()).norm();
  double apart = displacement(by_newton, by_ipopt).cwiseAbs().maxCoeff();
  if (mirror) {
    CHECK(by_newton.position.row(0).minCoeff() >= -1e-7 * extent);                 // Newton's method stays on the side that it begins on
    State image = by_newton;
    image.position.row(0) *= -1, image.low.row(0) *= -1;
    apart = std::min(apart, displacement(image, by_ipopt).cwiseAbs().maxCoeff());
  }
  CHECK(apart <= 1e-7 * extent);
  return report;
}

}  // namespace

TEST_CASE("Ipopt finds a column straight and bowed", "[solve][ipopt]") {
  for (const double shortening : {0.02, 0.1, 0.4}) {            // it buckles at 0.08
    INFO("shortened by " << shortening);
    Model model = chain(78, round_bond, round_angle, 1);
    model.plane_normal = 1;
    hold(model, 0, 1), hold(model, 76, 77, {true, true, true}, Vec3(0, 0, -shortening));
    Energy energy(model);
    State state = model.start;
    energy.kinematics().prescribe(state, 1);
    bow(energy, state, 0.01);
    const Report report = compare(model, energy, state, true);
    CHECK(report.iterations <= 60);
    REQUIRE(report.history.size() > 1);
    CHECK(report.history.back().residual < report.history.front().residual);
  }
}

TEST_CASE("a saddle that Ipopt ends at is left", "[solve][ipopt]") {
  Model model = chain(78, round_bond, round_angle, 1);
  model.plane_normal = 1;
  hold(model, 0, 1), hold(model, 76, 77, {true, true, true}, Vec3(0, 0, -0.4));
  Energy energy(model);
  State straight = model.start;
  energy.kinematics().prescribe(straight, 1);
  State state = straight;
  const Report alone = minimise_by_ipopt(energy, state, {});
  REQUIRE(alone.converged());
  CHECK(state.position.row(0).cwiseAbs().maxCoeff() == 0);      // nothing pushes it aside
  Newton newton(energy);
  state = straight;
  const Report report = minimise(newton, state, IpoptOptions{});
  REQUIRE(report.converged());
  CHECK(report.negative == 0);
  CHECK(report.energy < alone.energy / 2);
}

TEST_CASE("slenderness costs Ipopt no iterations and no digits", "[solve][ipopt]") {
  for (const int n : {20, 200, 2000}) {
    Model model = chain(n + 2, round_bond, round_angle, 1, Vec3::UnitX());
    model.plane_normal = 2;
    hold(model, 0, 1);
    const double L = n + 0.5;
    model.loads.push_back({"", {n + 1}, Vec3(0, 2 * round_angle / (L * L), 0), Scaling()});
    Energy energy(model);
    State state = model.start;
    energy.kinematics().prescribe(state, 1);
    const Report report = minimise_by_ipopt(energy, state, {});
    INFO(report.why);
    REQUIRE(report.converged());
    CHECK(report.residual <= 1e-13);
    CHECK(report.iterations <= 12);
    CHECK(state.position(1, n + 1) / L == Approx(0.4934575).epsilon(3.0 / (n * n) + 3e-7));   // elastica, Mattiasson 1981
  }
}

TEST_CASE("Ipopt finds what Newton's method finds at any scale", "[solve][ipopt]") {
  for (const double length : {1e-3, 1.0, 1e3})
    for (const double modulus : {1.0, 1e11}) {
      Model model = chain(20, round_bond * modulus * length, round_angle * modulus * length * length * length, length, Vec3::UnitX());
      hold(model, 0, 1);
      model.loads.push_back({"", {19}, Vec3(0, 0.02, -0.01) * modulus * length * length * round_angle, Scaling()});
      Energy energy(model);
      State state = model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = compare(model, energy, state);
      CHECK(report.iterations <= 12);
    }
}

TEST_CASE("Ipopt presses a ball into a sheet", "[solve][ipopt][contact]") {
  Plate sheet = plate(11, 13, false, 1, 1, 0.05);
  Model& m = sheet.model;
  sheet.hold(sheet.edge("two_layers_fixed"), [](const Vec3&) { return Vec3(0, 0, 0); });
  Wall ball;
  ball.particles = numbers(m.particles()), ball.inside = false, ball.effective_modulus = 10;
  ball.region.shape = Shape::sphere, ball.region.radius = 3;
  ball.region.center = Vec3(5.1, 5.3, 3.5), ball.displacement = Vec3(0, 0, -0.4);
  m.walls.push_back(ball);
  Energy energy(m);
  State state = m.start;
  energy.kinematics().prescribe(state, 1);
  compare(m, energy, state);
}

TEST_CASE("Ipopt presses two beams on each other", "[solve][ipopt][contact]") {
  Model m = chain(30, round_bond, round_angle, 1, Vec3::UnitX());
  const Model other = m;
  m.start.position.conservativeResize(3, 60), m.start.low.conservativeResize(3, 60);
  for (int i = 0; i < 30; ++i) m.start.set(30 + i, {other.start.position.col(i) + Vec3(0.3, 1.2, 0), Vec3::Zero()});
  for (const Bond& b : other.bonds) m.bonds.push_back({0, {b.particles[0] + 30, b.particles[1] + 30}});
  for (const Angle& a : other.angles) m.angles.push_back({0, {a.particles[0] + 30, a.particles[1] + 30, a.particles[2] + 30}});
  m.diameter.assign(60, 1), m.density.assign(60, 1), m.id = numbers(60), m.type.assign(60, 1), m.molecule.assign(60, 1);
  m.plane_normal = 2;
  hold(m, 0, 1), hold(m, 28, 29), hold(m, 30, 31), hold(m, 58, 59);
  PairContact c;
  c.particles = {numbers(30), numbers(30)}, c.effective_modulus = 1;
  for (int& p : c.particles[1]) p += 30;
  m.contacts.push_back(c);
  for (int i = 40; i < 50; ++i) m.loads.push_back({"", {i}, Vec3(0, -4e-4, 0), Scaling()});
  Energy energy(m);
  State state = m.start;
  energy.kinematics().prescribe(state, 1);
  compare(m, energy, state);
  CHECK(energy.touches(state).empty());                        // they did not touch before
}

TEST_CASE("Ipopt and Newton's method rest grains in a box alike", "[solve][ipopt][contact]") {
  const int n = 8;
  Field x(3, n);
  for (int i = 0; i < n; ++i) x.col(i) = Vec3(i % 2 ? 0.48 : -0.48, i / 2 % 2 ? 0.47 : -0.47, i / 4 ? 0.46 : -0.49) + 0.01 * Vec3(std::sin(3 * i), std::cos(5 * i), 0);
  Model m;
  add_grains(m, {{"grains", x, std::vector<double>(n, 1.0), 1000.0}});
  PairContact c;
  c.particles = {numbers(n), numbers(n)}, c.effective_modulus = 1e6;
  m.contacts.push_back(c);
  Wall box;
  box.particles = numbers(n), box.effective_modulus = 1e6, box.region.shape = Shape::block;
  box.region.lo = Vec3::Constant(-0.99), box.region.hi = Vec3::Constant(0.99);
  m.walls.push_back(box);
  m.gravity.push_back({"", numbers(n), Vec3(0, 0, -9.81), Scaling::constant()});
  Energy energy(m);
  compare(m, energy, m.start);
}

TEST_CASE("Ipopt's ends are told", "[solve][ipopt]") {
  Model model = chain(20, round_bond, round_angle, 1, Vec3::UnitX());
  hold(model, 0, 1);
  model.loads.push_back({"", {19}, Vec3(0, 1e-3, 0), Scaling()});
  Energy energy(model);
  State start = model.start;
  energy.kinematics().prescribe(start, 1);
  State state = start;
  Report report = minimise_by_ipopt(energy, state, {.max_iterations = 2});
  CHECK(report.status == Status::not_converged);
  CHECK(report.why.find("iterations were not enough") != std::string::npos);
  CHECK(report.iterations == 2);
  interrupt_requested = true;
  state = start;
  report = minimise_by_ipopt(energy, state, {});
  interrupt_requested = false;
  CHECK(report.status == Status::interrupted);

  Model flying;
  Field x(3, 1);
  x << 0, 0, 2;
  add_grains(flying, {{"grains", x, {1.0}, 1.0}});
  Wall floor;
  floor.particles = {}, floor.effective_modulus = 1, flying.walls.push_back(floor);
  flying.gravity.push_back({"", {0}, Vec3(0, 0, -1), Scaling::constant()});
  Energy falling(flying);
  state = flying.start;
  report = minimise_by_ipopt(falling, state, {});
  CHECK(report.status == Status::not_converged);
  CHECK(report.why.find("grains 1 moves away without end") != std::string::npos);
}
