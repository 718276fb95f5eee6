#include "catch.hpp"
#include "core/interrupt.hpp"
#include "hard_contacts.hpp"
#include "laws/check_law.hpp"
#include "laws/hard_contact.hpp"
#include "model/grains.hpp"
#include "path/equilibrium.hpp"
#include "solve/contact_equilibrium.hpp"

using namespace elamin;

namespace {

// A cantilever of n particles whose end is pressed towards a plane one diameter below.
Model pressed(int n, double load) {
  Model m = chain(n, round_bond, round_angle, 1, Vec3::UnitX());
  m.plane_normal = 1;
  hold(m, 0, 1);
  m.loads.push_back({"", {n - 1}, Vec3(0, 0, -load), Scaling::constant()});
  hard_plane(m, Vec3(0, 0, -1.5));
  return m;
}

// Three grains between a bowl that moves and grows and a driven grain, with any forces.
Model between(State& state) {
  Model m;
  Field x(3, 3);
  x << 0.1, 0.8, -0.3, 0.2, -0.1, 0.9, -2.2, -1.9, -1.2;
  add_grains(m, {{"grains", x, {1.0, 1.2, 0.8}, 1.0}});
  meet_hard(m);
  Wall& bowl = hard_plane(m);
  bowl.region.shape = Shape::sphere, bowl.region.radius = 3, bowl.displacement = Vec3(0.1, -0.2, 0.3), bowl.radius_change = 0.4;
  hold(m, 2, 2, {true, false, true}, Vec3(0.5, 0, -0.3));
  state = m.start;
  state.load_factor = 0;
  state.hard = {{0, 1, -1, -1, 0.7}, {1, 2, -1, -1, 0.4}, {0, -1, 0, 0, 1.3}, {2, -1, 0, 0, 0.2}};
  return m;
}

}  // namespace

TEST_CASE("hard contacts agree with differences of their value", "[laws][hard]") {
  for (const double size : {1e-3, 1.0, 1e3}) {
    Points<2> x;
    x.position << 0.1, 0.7, -0.4, 0.9, 0.3, 0.2;
    x.position *= size;
    const HardContact pair{2.5, 1.1 * size};
    CHECK(check_law(pair, x, size) == std::vector<std::string>{});
    CHECK(pair.gap(x) == Approx((x.position.col(1) - x.position.col(0)).norm() - 1.1 * size).epsilon(1e-13));
    Region bowl;
    bowl.shape = Shape::sphere, bowl.radius = 2 * size;
    Region pipe;
    pipe.shape = Shape::cylinder, pipe.radius = 2 * size, pipe.open = {true, true, false};
    Region cone;
    cone.shape = Shape::cone, cone.axial_lo = -3 * size, cone.axial_hi = 3 * size, cone.radius_lo = size, cone.radius_hi = 2 * size;
    Points<1> at;
    at.position << 0.3 * size, 0.5 * size, -0.4 * size;
    CHECK(check_law(HardWall{1.7, bowl, true, 0.1 * size, 0}, at, size) == std::vector<std::string>{});
    CHECK(check_law(HardWall{1.7, pipe, true, 0.1 * size, 2}, at, size) == std::vector<std::string>{});
    CHECK(check_law(HardWall{1.7, cone, true, 0.1 * size, 2}, at, size) == std::vector<std::string>{});
    at.position *= 6;
    CHECK(check_law(HardWall{1.7, bowl, false, 0.1 * size, 0}, at, size) == std::vector<std::string>{});
    CHECK(HardWall{1.7, bowl, true, 0.1 * size, 0}.value(at) == std::numeric_limits<double>::infinity());
  }
}

TEST_CASE("the Lagrangian's derivatives agree with differences", "[energy][hard]") {
  State state;
  const Model m = between(state);
  Energy energy(m);
  const auto lagrangian = [&](const State& s) {
    double l = energy.value(s);
    HardGap gap;
    for (const HardForce& h : s.hard) {
      REQUIRE(hard_gap(m, h, s, gap));
      l -= h.force * gap.value;
    }
    return l;
  };
  energy.evaluate(state);
  const Vector g = energy.gradient(), rate = energy.load_derivative();
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  REQUIRE(energy.null_dofs().empty());
  const double h = 1e-3;
  const auto gradient_at = [&](const State& s) {
    energy.evaluate(s);
    return Vector(energy.gradient());
  };
  for (int d = 0; d < energy.dofs(); ++d) {
    const auto moved_by = [&](double s) {
      State y = state;
      energy.kinematics().retract(y, Vector::Unit(energy.dofs(), d), s);
      return y;
    };
    CHECK(std::abs(difference([&](double s) { return lagrangian(moved_by(s)); }, h) - g[d]) <= 1e-9);
    const Vector column = difference([&](double s) { return gradient_at(moved_by(s)); }, h);
    CHECK((column - H.col(d)).cwiseAbs().maxCoeff() <= 1e-9);
  }
  const Vector by_load = difference([&](double s) {
    State y = state;
    energy.kinematics().prescribe(y, s);
    return gradient_at(y);
  }, h);
  CHECK((by_load - rate).cwiseAbs().maxCoeff() <= 1e-9);
  CHECK(rate.norm() > 0.1);
  // Forces hold each other in balance, and touches tell them.
  Field total = energy.forces(state);
  for (const Touch& t : energy.touches(state)) {
    total.col(t.particle) -= t.force;
    if (t.other >= 0) total.col(t.other) += t.force;
  }
  CHECK(energy.touches(state).size() == 4);
  CHECK(total.norm() <= 1e-14);
  CHECK(energy.terms(state).total() == 0);
}

TEST_CASE("a stack of hard grains carries its weights, in any units", "[solve][hard]") {
  for (const double unit : {1e-3, 1.0, 1e3}) {
    Model m;
    Field x(3, 4);
    x << 0, 0, 0, 0, 0, 0, 0, 0, 0.45, 3, 6, 20;                // the lowest one overlaps the floor a little
    add_grains(m, {{"grains", x * unit, std::vector<double>(4, unit), 1e-4 / unit}});
    meet_hard(m), hard_plane(m), weigh(m, 1);
    m.supports.push_back({"", numbers(4), {true, true, false}, Vec3::Zero(), Scaling()});
    Energy energy(m);
    State state = m.start;
    const Report report = rest(energy, state);
    CHECK(report.negative == 0);
    REQUIRE(state.hard.size() == 4);
    const double weight = m.mass(0);
    for (int i = 0; i < 4; ++i) CHECK(state.position(2, i) == Approx((i + 0.5) * unit).epsilon(1e-13));
    for (const HardForce& h : state.hard) CHECK(h.force == Approx((h.wall >= 0 ? 4 : 3 - h.particle) * weight).epsilon(1e-12));
    Vec3 carried = Vec3::Zero();
    for (const Touch& t : energy.touches(state))
      if (t.wall >= 0) carried += t.force;
    CHECK((carried - Vec3(0, 0, 4 * weight)).norm() <= 1e-12 * weight);
  }
}

TEST_CASE("hard grains settle in a hard box", "[solve][hard]") {
  const int n = 12;
  Field x(3, n);
  for (int i = 0; i < n; ++i) x.col(i) = Vec3(i % 2 ? 0.52 : -0.53, i / 2 % 2 ? 0.51 : -0.54, 1.1 * (i / 4) - 0.4) + 0.03 * Vec3(std::sin(3 * i), std::cos(5 * i), 0);
  Model m;
  add_grains(m, {{"grains", x, std::vector<double>(n, 1.0), 1000.0}});
  meet_hard(m), weigh(m, 9.81);
  Wall& box = hard_plane(m);
  box.region.shape = Shape::block, box.region.lo = Vec3(-1.13, -1.11, -1), box.region.hi = Vec3(1.13, 1.11, 9);
  Energy energy(m);
  State state = m.start;
  const Report report = rest(energy, state);
  CHECK(report.negative == 0);
  Vec3 carried = Vec3::Zero(), weight = Vec3::Zero();
  for (int i = 0; i < n; ++i) weight += m.mass(i) * Vec3(0, 0, -9.81);
  for (const Touch& t : energy.touches(state))
    if (t.wall >= 0) carried += t.force;
  CHECK((carried + weight).norm() <= 1e-9 * weight.norm());
  CHECK(static_cast<int>(state.hard.size()) >= 3 * n - 4);      // as many as hold them
}

TEST_CASE("a beam pressed on a hard plane is a beam whose end is held", "[solve][hard]") {
  for (const int n : {20, 78}) {
    const double load = 40 * round_angle / (n * n);
    const Model m = pressed(n, load);
    Energy energy(m);
    State state = m.start;
    rest(energy, state);
    REQUIRE(state.hard.size() == 1);
    CHECK(state.hard[0].particle == n - 1);
    Model held = chain(n, round_bond, round_angle, 1, Vec3::UnitX());
    held.plane_normal = 1;
    hold(held, 0, 1), hold(held, n - 1, n - 1, {false, false, true}, Vec3(0, 0, -1));
    Energy without(held);
    Newton newton(without);
    State other = held.start;
    without.kinematics().prescribe(other, 1);
    REQUIRE(newton.minimise(other).converged());
    CHECK(displacement(state, other).cwiseAbs().maxCoeff() <= 1e-11);
    CHECK(load - state.hard[0].force == Approx(without.forces(other)(2, n - 1)).epsilon(1e-9));
  }
}

TEST_CASE("a heavy beam lies flat on a hard plane", "[solve][hard]") {
  const int n = 40;
  Model m = chain(n, round_bond, round_angle, 1, Vec3::UnitX());
  m.plane_normal = 1;
  hold(m, 0, 1), hard_plane(m, Vec3(0, 0, -1.5)), weigh(m, 400 * round_angle / (n * n * n));
  Energy energy(m);
  State state = m.start;
  rest(energy, state);
  const double weight = m.mass(0) * 400 * round_angle / (n * n * n);
  REQUIRE(state.hard.size() > 20);
  // Where it lies every particle carries itself; the first two contacts carry besides what hangs free and bends.
  for (std::size_t k = 3; k < state.hard.size(); ++k) CHECK(state.hard[k].force == Approx(weight).epsilon(1e-9));
  double total = 0;
  for (const HardForce& h : state.hard) total += h.force;
  const Field forces = energy.forces(state);
  CHECK(total - forces(2, 0) - forces(2, 1) == Approx(n * weight).epsilon(1e-10));
}

TEST_CASE("Hertz's contact hardens as E^(-2/3)", "[solve][hard]") {
  const int n = 20;
  const Model hard = pressed(n, 40 * round_angle / (n * n));
  Energy limit(hard);
  State there = hard.start;
  rest(limit, there);
  std::vector<double> distance;
  for (const double modulus : {1e2, 1e4, 1e6}) {
    Model m = hard;
    m.walls[0].hard = false, m.walls[0].effective_modulus = modulus;
    Energy energy(m);
    State state = there;
    state.hard.clear();
    const Report report = minimise_by_ipopt(energy, state, {});
    INFO(report.why);
    REQUIRE(report.converged());
    distance.push_back(displacement(there, state).norm());
  }
  for (std::size_t k = 1; k < distance.size(); ++k) {
    const double order = std::log(distance[k - 1] / distance[k]) / std::log(1e2);
    CHECK(order == Approx(2.0 / 3).epsilon(k == 1 ? 0.01 : 0.001));
  }
}

TEST_CASE("hard contacts decide what is stable", "[solve][hard]") {
  Model m;
  Field x(3, 1);
  x << 0, 0, 0;
  add_grains(m, {{"grain", x, {1.0}, 1.0}});
  weigh(m, 2);
  Wall& ball = hard_plane(m);
  ball.region.shape = Shape::sphere, ball.region.radius = 3;
  const double weight = 2 * m.mass(0);
  {                                                              // at the bottom of a bowl: stiffness m g/(R − r)
    m.start.position(2, 0) = -2.5;
    Energy energy(m);
    State state = m.start;
    state.hard = {{0, -1, 0, 0, weight}};
    ContactEquilibrium equilibrium(energy);
    REQUIRE(equilibrium.correct(state, 1e-10).converged());
    CHECK(equilibrium.inertia(state).positive_definite());
    const EigenPairs lowest = equilibrium.lowest(state, 2);
    CHECK(lowest.values[0] == Approx(weight / 2.5).epsilon(1e-6));
    CHECK(lowest.values[1] == Approx(weight / 2.5).epsilon(1e-6));
    const std::function<bool()> at_once = [] { return true; };   // nothing is known of the two directions that the contact leaves
    stop_asked = &at_once;
    CHECK(equilibrium.inertia(state).zero == 2);
    stop_asked = nullptr;
    State other = m.start;
    other.position.col(0) = Vec3(1.7, 0.4, 0.3);
    rest(energy, other);
    CHECK(displacement(state, other).norm() <= 1e-9);
  }
  {                                                              // on top of a ball
    m.walls[0].inside = false;
    m.start.position(2, 0) = 3.5;
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    state.hard = {{0, -1, 0, 0, weight}};
    ContactEquilibrium equilibrium(energy);
    const Report report = equilibrium.correct(state, 1e-10);
    REQUIRE(report.converged());
    CHECK(equilibrium.inertia(state).negative == 2);
    CHECK(assess(newton, state, report).point.stability.negative == 2);
    CHECK_FALSE(assess(newton, state, report).point.stability.stable);
  }
}
