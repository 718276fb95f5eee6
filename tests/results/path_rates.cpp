// Derivatives along the path of equilibria, against closed forms and against the work of forces.
#include "results/path_rates.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "results/sample.hpp"

using namespace elamin;

namespace {

ObserveTable derivative(const std::string& name, const std::string& of, const std::string& by = "lambda") {
  ObserveTable o;
  o.name = name, o.quantity = Quantity::derivative, o.of = {of}, o.by = by;
  return o;
}

std::vector<double> values(const Problem& problem, const Model& m, const State& state) {
  Energy energy(m);
  const Observables observables(problem, m);
  return observables.evaluate(state, energy.forces(state), observed_touches(energy, state, observables));
}

State settled(const Model& m, double load_factor, State state, Pace pace = Pace::long_steps) {
  Energy energy(m);
  Newton newton(energy);
  energy.kinematics().prescribe(state, load_factor);
  REQUIRE((pace == Pace::stationary ? newton.correct(state) : newton.minimise(state)).converged());
  return state;
}

// A shallow truss in the plane xy: pins at (−1, 0) and (1, 0), bonds of rest length √(1 + 0.09) and stiffness K, the apex pushed down.
struct Truss {
  static constexpr double K = 50, rise = 0.3;
  const double rest = std::hypot(1, rise);
  Model model;
  Truss() {
    model = chain(3, K, 0, rest);
    model.angles.clear();
    model.start.position << -1, 0, 1, 0, rise, 0, 0, 0, 0;
    model.start.low.setZero();
    hold(model, 0, 0), hold(model, 2, 2);
    model.loads.push_back({"", {1}, Vec3(0, -1, 0), Scaling()});
    model.plane_normal = 2;
    model.groups = {{"apex", {1}}, {"right", {2}}, {"all", {0, 1, 2}}};
  }
  // At height y the load is λ = −2·2K (r − rest) y/r, and dλ/dy = −4K (1 − rest/r³), r³ = (1 + y²)^{3/2}.
  double load(double y) const { return -4 * K * y * (1 - rest / std::hypot(1, y)); }
  double stiffness(double y) const { return -4 * K * (1 - rest / std::pow(1 + y * y, 1.5)); }
  State at(double y) const {
    State state = model.start;
    state.position(1, 1) = y;
    return settled(model, load(y), state, Pace::stationary);
  }
};

}  // namespace

TEST_CASE("springs in series: the force rises by what the springs together bear", "[derivative]") {
  const double scale = GENERATE(1e-3, 1e3);
  Model m = chain(4, 1, 0, scale, Vec3::UnitX());
  m.angles.clear();
  m.bond_types = {{3, scale}, {5, scale}, {11, scale}}, m.bonds[1].type = 1, m.bonds[2].type = 2;
  hold(m, 0, 0), hold(m, 3, 3, {true, true, true}, Vec3(0.01 * scale, 0, 0));
  hold(m, 1, 2, {false, true, true});
  m.groups = {{"end", {3}}, {"second", {1}}};
  Problem problem;
  problem.observe = {observe("force", "end", Quantity::reaction, Component::x, Reduce::sum), observe("way", "end", Quantity::displacement, Component::x, Reduce::mean),
                     observe("part", "second", Quantity::displacement, Component::x, Reduce::mean), derivative("by_load", "force"), derivative("k", "force", "way"),
                     derivative("share", "part", "way")};
  const double together = 1 / (1 / 6.0 + 1 / 10.0 + 1 / 22.0);            // of 2K each
  const std::vector<double> v = values(problem, m, settled(m, 0.7, m.start));
  // All is linear: what is left is the rounding of a force over the longest step, a tenth of a bond's length.
  CHECK(v[3] == Approx(together * 0.01 * scale).epsilon(1e-12));
  CHECK(v[4] == Approx(together).epsilon(1e-12));
  CHECK(v[5] == Approx(together / 6).epsilon(1e-12));
}

TEST_CASE("a truss: its stiffness on both sides of the limit point, and there", "[derivative]") {
  const Truss two_bars;
  Problem problem;
  problem.observe = {observe("y", "apex", Quantity::position, Component::y, Reduce::mean), observe("thrust", "right", Quantity::reaction, Component::x, Reduce::sum),
                     observe("T", "all", Quantity::tension, Component::x, Reduce::max), observe("U", "all", Quantity::energy, Component::x, Reduce::sum),
                     derivative("dy", "y"), derivative("thrust_by_y", "thrust", "y"), derivative("T_by_y", "T", "y"), derivative("U_by_y", "U", "y")};
  const double limit = std::sqrt(std::pow(two_bars.rest, 2.0 / 3) - 1);
  for (const double y : {0.29, 0.2, limit, 0.1, -0.15, -0.4}) {
    CAPTURE(y);
    State state = two_bars.model.start;
    if (y == limit) state.position(1, 1) = y, state.load_factor = two_bars.load(y);       // to rounding
    else state = two_bars.at(y);
    const std::vector<double> v = values(problem, two_bars.model, state);
    const double r = std::hypot(1, y), rate = 2 * Truss::K * y / r;         // of a bond's tension by y
    // About ten digits; near the limit point the place is known as well as the load divided by the stiffness.
    if (y == limit) CHECK_FALSE(std::abs(v[4]) < 1e6);
    else CHECK(v[4] == Approx(1 / two_bars.stiffness(y)).epsilon(1e-9));
    const double tension = 2 * Truss::K * (r - two_bars.rest);
    CHECK(v[6] == Approx(rate).epsilon(1e-9));
    CHECK(v[5] == Approx(rate / r - tension * y / (r * r * r)).epsilon(1e-9));            // of T/r, x = 1
    CHECK(v[7] == Approx(-two_bars.load(y)).epsilon(1e-9));                    // dU = −λ dy
  }
}

TEST_CASE("a slender column far behind its buckling: what differences of solved equilibria tell", "[derivative]") {
  const int n = 41;
  Model m = chain(n, 500, 0.5, 1);
  m.plane_normal = 1;
  const double euler = 0.5 * pi * pi / ((n - 1) * (n - 1));
  hold(m, 0, 0), hold(m, n - 1, n - 1, {true, true, false});
  m.loads.push_back({"", {n - 1}, Vec3(0, 0, -euler), Scaling()});
  m.groups = {{"top", {n - 1}}, {"mid", {n / 2}}, {"all", numbers(n)}};
  Problem problem;
  problem.observe = {observe("z", "top", Quantity::displacement, Component::z, Reduce::mean), observe("x", "mid", Quantity::position, Component::x, Reduce::mean),
                     observe("M", "mid", Quantity::moment, Component::x, Reduce::mean), observe("U", "all", Quantity::energy, Component::x, Reduce::sum),
                     derivative("dz", "z"), derivative("dx", "x"), derivative("dM", "M"), derivative("U_by_z", "U", "z")};
  State bent = m.start;
  for (int i = 1; i + 1 < n; ++i) bent.position(0, i) = 8 * std::sin(pi * i / (n - 1));
  const double at = 1.3;
  const State state = settled(m, at, bent);
  const std::vector<double> v = values(problem, m, state);
  // Central differences over h and h/2, extrapolated: the error is of the order of h⁴, below 1e-8 of the derivative.
  std::array<std::vector<double>, 2> differences;
  for (int k = 0; k < 2; ++k) {
    const double h = 0.004 / (1 << k);
    const std::vector<double> ahead = values(problem, m, settled(m, at + h, state)), behind = values(problem, m, settled(m, at - h, state));
    for (int i = 0; i < 3; ++i) differences[k].push_back((ahead[i] - behind[i]) / (2 * h));
  }
  for (int i = 0; i < 3; ++i) CHECK(v[4 + i] == Approx((4 * differences[1][i] - differences[0][i]) / 3).epsilon(1e-7));
  CHECK(v[7] == Approx(-euler * at).epsilon(1e-8));
  CHECK(v[6] == Approx(-euler * (v[1] + at * v[5])).epsilon(1e-8));             // M = −P x, sign as of a turn about +y
}

TEST_CASE("at a branch point the path has more than one tangent, and no derivative", "[derivative]") {
  const int n = 3;
  Model m = chain(n, 100, 1, 1);
  m.plane_normal = 1;
  hold(m, 0, 0, {true, true, true}), hold(m, 2, 2, {true, true, false});
  m.loads.push_back({"", {2}, Vec3(0, 0, -1), Scaling()});
  m.groups = {{"top", {2}}};
  Problem problem;
  problem.observe = {observe("z", "top", Quantity::displacement, Component::z, Reduce::mean), derivative("dz", "z")};
  // Bonds of length q bear the thrust P; the middle goes aside where 4B/q² = 2P/q, P = 2K (1 − q).
  const double q = (1 + std::sqrt(1 - 4.0 / 100)) / 2, P = 200 * (1 - q);
  REQUIRE(4 / (q * q) == Approx(2 * P / q).epsilon(1e-12));
  State state = m.start;
  state.position(2, 1) = q, state.position(2, 2) = 2 * q, state.load_factor = P;
  CHECK_FALSE(std::isfinite(values(problem, m, state)[1]));
  state = settled(m, 0.99 * P, m.start, Pace::stationary);
  CHECK(values(problem, m, state)[1] == Approx(-2 / 200.0).epsilon(1e-11));
}

TEST_CASE("Hertz's contact between two grains: the stiffness is 3/2 F over the overlap", "[derivative]") {
  const double overlap = GENERATE(1e-2, 1e-5, 1e-8);
  Model m = chain(2, 0, 0, 1);
  m.bonds.clear(), m.angles.clear();
  PairContact c;
  c.particles = {numbers(2), numbers(2)}, c.effective_modulus = 1e3;
  m.contacts.push_back(c);
  hold(m, 0, 0), hold(m, 1, 1, {true, true, true}, Vec3(0, 0, -1));
  m.groups = {{"top", {1}}};
  Problem problem;
  problem.observe = {observe("F", "top", Quantity::reaction, Component::z, Reduce::sum), derivative("k", "F"),
                     observe("C", "top", Quantity::contact_force, Component::z, Reduce::sum), derivative("kc", "C")};
  State state = settled(m, overlap, m.start);
  const std::vector<double> v = values(problem, m, state);
  const double force = 4.0 / 3 * 1e3 * std::sqrt(0.25) * std::pow(overlap, 1.5);
  CHECK(v[0] == Approx(-force).epsilon(1e-7));                            // the overlap is rounded at the size of a grain
  CHECK(v[1] == Approx(-1.5 * v[0] / (-overlap)).epsilon(1e-7));
  CHECK(v[3] == Approx(-v[1]).epsilon(1e-9));
}

TEST_CASE("hard contacts stay closed along the path, with forces that change", "[derivative]") {
  // A grain on a spring over a hard floor that rises: the spring is pressed by as much.
  Model m = chain(2, 7, 0, 2);
  m.angles.clear(), m.diameter = {1, 1};
  Wall floor;
  floor.particles = {0}, floor.hard = true, floor.displacement = Vec3(0, 0, 1);
  floor.region.shape = Shape::plane, floor.region.center = Vec3(0, 0, -0.5), floor.region.normal = Vec3(0, 0, 1);
  m.walls.push_back(floor);
  hold(m, 0, 0, {true, true, false}), hold(m, 1, 1);
  m.groups = {{"top", {1}}, {"ball", {0}}};
  Problem problem;
  problem.observe = {observe("F", "top", Quantity::reaction, Component::z, Reduce::sum), observe("C", "ball", Quantity::contact_force, Component::z, Reduce::sum),
                     derivative("k", "F"), derivative("kc", "C")};
  State state = m.start;
  state.position(2, 0) = 0.25, state.load_factor = 0.25;
  state.hard = {{0, -1, 0, 0, 2 * 7 * 0.25}};
  const std::vector<double> v = values(problem, m, state);
  CHECK(v[0] == Approx(-3.5).epsilon(1e-12));
  CHECK(v[1] == Approx(3.5).epsilon(1e-12));
  CHECK(v[2] == Approx(-14).epsilon(1e-9));                               // their equations are softened by 1e-10 of the stiffness, see limits.hpp
  CHECK(v[3] == Approx(14).epsilon(1e-9));
  // Where it just touches, the path has a corner.
  state.position(2, 0) = 0, state.load_factor = 0, state.hard.clear();
  CHECK_FALSE(std::isfinite(values(problem, m, state)[2]));
}
