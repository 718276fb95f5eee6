#include "catch.hpp"
#include "chain.hpp"
#include "core/interrupt.hpp"
#include "solve/newton.hpp"

using namespace elamin;

namespace {

// A straight chain of m links of length 1/m, EI = 1, clamped at one end or at both, under the axial force (1 + off) times its lowest
// critical one. With θ the links' turns, ℓ their length under the force P:  E = B/2 Σ (θᵢ₊₁ − θᵢ)² − Pℓ/2 Σ θᵢ²; θ₀ = 0 at a clamp, so
//   Pℓ/B = 2 − 2 cos(π/(2m + 1))  free at the other end,   2 − 2 cos(2π/(m + 1))  clamped there too (Σ θᵢ = 0).
Model column(int m, double slenderness, bool clamped, bool plane, const Vec3& axis, double off, State& state) {
  const double q0 = 1.0 / m, B = m, K = slenderness / (2 * q0);
  const double c = (1 + off) * (2 - 2 * std::cos(clamped ? 2 * pi / (m + 1) : pi / (2 * m + 1)));
  const double length = (q0 + std::sqrt(q0 * q0 - 2 * B * c / K)) / 2, P = B * c / length;
  Model model = chain(clamped ? m + 3 : m + 2, K, B, q0, axis);
  if (plane) model.plane_normal = 1;
  hold(model, 0, 1);
  if (clamped) hold(model, m + 1, m + 2, {true, true, true}, -axis.normalized() * (m * P / (2 * K)));
  else model.loads.push_back({"", {m + 1}, -axis.normalized() * P, Scaling()});
  state = model.start;
  for (int i = 2; i < (clamped ? m + 1 : m + 2); ++i) state.position.col(i) -= axis.normalized() * ((i - 1) * P / (2 * K));
  return model;
}

Inertia inertia_of(const Model& model, State state) {
  Energy energy(model);
  Newton newton(energy);
  energy.kinematics().prescribe(state, 1);
  REQUIRE(newton.correct(state).converged());
  energy.evaluate(state);
  return newton.factors().inertia();
}

void check_columns(int m, double slenderness, std::initializer_list<double> offs) {
  for (const bool clamped : {false, true})
    for (const bool plane : {true, false})
      for (const Vec3& axis : {Vec3(0, 0, 1), plane ? Vec3(0.3, 0, 1) : Vec3(1, -2, 0.7)})
        for (const double off : offs) {
          State state;
          const Model model = column(m, slenderness, clamped, plane, axis, off, state);
          INFO(m << " links, EA L²/EI = " << slenderness << (clamped ? ", clamped" : "") << (plane ? ", plane" : "") << ", P/P_c − 1 = " << off);
          const Inertia inertia = inertia_of(model, state);
          CHECK(inertia.negative == (off < 0 ? 0 : plane ? 1 : 2));
          CHECK(inertia.zero == 0);
        }
}

}  // namespace

TEST_CASE("signs at critical loads are right for any slenderness", "[solve]") {
  for (const int m : {8, 30, 100})
    for (const double slenderness : {1e3, 1e6, 1e8, 1e10}) {
      const double off = 1e-6;
      if (slenderness < 100 * m) check_columns(m, slenderness, {-off, off});
      else check_columns(m, slenderness, {-1e-2, -off, off, 1e-2});
    }
}

TEST_CASE("a slender chain of ten thousand particles is told stable from buckled", "[solve]") {
  const int m = 10'000;
  State state;
  for (const double off : {-1.0, -0.01, 0.01}) {
    const Model model = column(m, 16.0 * m * m, false, true, Vec3(0.3, 0, 1), off, state);
    const Inertia inertia = inertia_of(model, state);
    CHECK(inertia.negative == (off > 0));
    CHECK(inertia.zero == 0);
  }
}

TEST_CASE("motions that cost nothing stay zero at any scale", "[solve]") {
  for (const int n : {3, 10, 200})
    for (const double length : {1e-6, 1.0, 1e3})
      for (const double modulus : {1.0, 1e11})
        for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, -2, 0.7), Vec3(1e-5, 1, 0)}) {
          const double d = length / n, K = 0.39 * modulus * d, B = 0.049 * modulus * d * d * d;
          INFO(n << " particles, length " << length << ", modulus " << modulus);
          Model free = chain(n, K, B, d, axis);
          CHECK(inertia_of(free, free.start).zero == 5);         // it may not spin: particles do not turn
          Model hinged = free;
          hold(hinged, 0, 0);
          CHECK(inertia_of(hinged, hinged.start).zero == 2);
          hinged.loads.push_back({"", {n - 1}, axis.normalized() * (1e-3 * K * d), Scaling()});
          const Inertia pulled = inertia_of(hinged, hinged.start);
          CHECK(pulled.zero == 0);
          CHECK(pulled.negative == 0);
        }
}

TEST_CASE("solutions with an eigenvalue below the rounding of the assembled Hessian have digits", "[solve]") {
  // The tip of a column of 400 links under 99.9 % of its critical load, EA L²/EI = 1e10, yields 1000 times more to a side force.
  const int m = 400;
  State state;
  for (const double off : {-1e-3, 1e-3}) {
    const Model model = column(m, 1e10, false, true, Vec3(0.3, 0, 1), off, state);
    Energy energy(model);
    Newton newton(energy);
    energy.kinematics().prescribe(state, 1);
    REQUIRE(newton.correct(state).converged());
    energy.evaluate(state);
    const Inertia inertia = newton.factors().inertia();
    CHECK(inertia.zero == 0);
    const Vector b = Vector::LinSpaced(energy.dofs(), 0, 1).array().sin();
    const Vector p = newton.factors().solve_holding(b), again = p + newton.factors().solve_holding(b - energy.multiply(p));
    CHECK((again - p).norm() <= 1e-3 * p.norm());               // 8 ε EA/P_c over |off|, see above
    CHECK((b.dot(p) < 0) == (off > 0));
  }
}

TEST_CASE("solutions are those of the Hessian where the factor that told the inertia is shifted by nearly as much as its lowest eigenvalue", "[solve]") {
  // One particle that three bonds at rest hold along x, y and z: H = diag(2K).
  for (const double times : {1.01, 1.1, 1.5, 3.0, 100.0}) {
    Model model = chain(4, 1, 0, 1);
    model.start.position << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    model.angles.clear(), model.bonds.clear();
    hold(model, 1, 3);
    for (int axis = 0; axis < 3; ++axis) model.bonds.push_back({axis, {0, axis + 1}});
    model.bond_types = {{1, 1}, {1, 1}, {0, 1}};
    double zero_level = 0;
    {
      Energy energy(model);
      Newton newton(energy);
      energy.evaluate(model.start);
      zero_level = newton.factors().zero_level();
    }
    const double weak = times * zero_level;
    model.bond_types[2].stiffness = weak / 2;
    Energy energy(model);
    Newton newton(energy);
    energy.evaluate(model.start);
    const Inertia inertia = newton.factors().inertia();
    INFO(times << " times the zero level");
    CHECK(inertia.negative == 0);
    CHECK(inertia.zero == 0);
    const Vector b = Vector::Unit(energy.dofs(), 2), p = newton.factors().solve_holding(b);
    CHECK(p[2] * weak == Approx(1).epsilon(0.1 / (1 - 0.1)));     // what is left of a shift that is at most 0.1 of the solution
  }
}

TEST_CASE("what has no stiffness at all is a result with a sentence", "[solve]") {
  Model model = chain(3, 0, 0, 1);
  hold(model, 0, 0);
  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  for (const Report& report : {newton.minimise(state), newton.correct(state)}) {
    CHECK(report.status == Status::not_converged);
    CHECK(report.why.find("nothing here has a stiffness") != std::string::npos);
  }
  CHECK(newton.factors().inertia().zero == energy.dofs());
}

TEST_CASE("signs are looked for until a program asks to stop, at whatever moment", "[solve]") {
  State state;
  const Model model = column(40, 1e8, true, true, Vec3::UnitZ(), 1e-7, state);
  const int negative = inertia_of(model, state).negative;
  Energy energy(model);
  Newton newton(energy);
  energy.kinematics().prescribe(state, 1);
  REQUIRE(newton.correct(state).converged());
  energy.evaluate(state);
  int asked = 0, all = 0;
  for (int patience = 0; patience <= all || patience == 0; ++patience) {
    asked = 0;
    const std::function<bool()> stop = [&] { return ++asked > patience; };
    stop_asked = &stop;
    const Inertia inertia = newton.factors().inertia();
    stop_asked = nullptr;
    all = std::max(all, asked);
    if (asked <= patience) CHECK(inertia.negative == negative);      // it was never stopped
    REQUIRE(patience < 10000);
  }
  CHECK(all > 3);
}

TEST_CASE("the search for a shift ends", "[solve]") {
  int attempts = 0;
  CHECK_FALSE(first_shift(0, 0, 1.5, [&](double) { return ++attempts > 1000; }));
  CHECK_FALSE(first_shift(1e-300, 1e-300, 1.5, [&](double) { return ++attempts > 1000; }));
  CHECK_FALSE(first_shift(1, 1, 1e30, [&](double shift) { CHECK(std::isfinite(shift)); return ++attempts > 1000; }));
  CHECK(attempts < 200);
  CHECK(first_shift(0, 1, 2, [](double shift) { return shift >= 4; }) == 4);
}
