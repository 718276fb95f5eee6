#include "proof/theorem.hpp"

#include "proof/inertia.hpp"

#include <fmt/format.h>

#include <cfenv>

namespace elamin::proof {

namespace {

using I = Interval<double>;
using Q = Interval<Quad>;

constexpr double most_contraction = 0.85;        // q: what is left is for who checks the proof with bounds of his own

double norm(const std::vector<Q>& g) {
  Q sum;
  for (const Q& x : g) sum += square(x);
  return I(sqrt(sum)).hi;
}

double distance(const State& a, const State& b) {
  std::vector<Q> d;
  for (Eigen::Index k = 0; k < a.position.size(); ++k) d.push_back((Q(b.position(k)) - Q(a.position(k))) + (Q(b.low(k)) - Q(a.low(k))));
  return norm(d);
}

// Steps with the factor of one matrix while the residual falls; returns its bound.
double refine(const Structure& s, const SparseMatrix& M, State& x) {
  ShiftedFactor factor(M);
  std::vector<Q> g = s.gradient(x);
  double residual = norm(g);
  if (s.dofs == 0 || !factor.factorize(M, 0)) return residual;
  for (int k = 0; k < 12; ++k) {
    const Vector step = factor.solve(Vector::NullaryExpr(s.dofs, [&](Eigen::Index i) { return static_cast<double>(g[i].middle()); }));
    State next = x;
    for (int p = 0; p < x.particles(); ++p) {
      ExactVector to = x.at(p);
      for (int c = 0; c < 3; ++c)
        if (const int i = s.dof[p][c]; i >= 0) to.set(c, to[c] + (-step[i]));
      next.set(p, to);
    }
    std::vector<Q> at = s.gradient(next);
    const double now = norm(at);
    if (!(now < residual / 2)) break;
    x = std::move(next), g = std::move(at), residual = now;
  }
  return residual;
}

void bound_gaps(const Structure& s, Theorem& t) {
  const auto sort = [&](const auto& elements) {
    for (const auto& [law, at] : elements) {
      const bool wall = at.size() == 1;
      const Q bound = gap(law, s.edge<Q>(t.centre, wall ? -1 : at[0], at.back(), t.error));
      (bound.hi < 0 ? t.closed : bound.lo > 0 ? t.open : t.undecided).push_back({{at[0], wall ? -1 : at.back()}, I(bound)});
    }
  };
  sort(s.contacts), sort(s.planes), sort(s.rounds);
}

}  // namespace

Theorem prove(const Structure& s, const State& state) {
  Theorem t;
  t.centre = state;
  const auto refuse = [&](std::string why) { return t.why_not = std::move(why), t; };
  if (s.dofs == 0) return refuse("nothing is free to move");
  if (std::fegetround() != FE_TONEAREST) return refuse("the processor does not round to nearest");
  IntervalHessian hessian(s, state);
  const SparseMatrix M = hessian.middle(state);
  t.residual = refine(s, M, t.centre);
  t.moved = distance(state, t.centre);
  const Spectrum spectrum = spectrum_near_zero(M);
  t.negative = spectrum.negative, t.shift = spectrum.shift;
  if (spectrum.estimate == 0) return refuse("the Hessian may be singular: a pivot of its factor is zero");
  if (!(spectrum.least > 0))
    return refuse(fmt::format("the Hessian may be singular: its eigenvalue next to zero, about {:.2g}, is not told from zero, "
                              "as rounding may change the eigenvalues of a factor by {:.2g}", spectrum.estimate, spectrum.error));
  if (!(t.moved < s.reach / 8)) return refuse("no equilibrium is near: Newton's method moves away from the state");
  t.inverse = (I(1) / I(spectrum.least)).hi;
  const double smallest = (I(t.inverse) * I(t.residual)).hi;   // no ball can be smaller
  double ball = s.reach / 8;
  for (int k = 0; k < 60; ++k) {
    t.radius = ball, t.change = hessian.distance(M, t.centre, ball);
    const I q = I(t.inverse) * I(t.change);
    if (q.hi <= most_contraction && (I(t.inverse) * (I(t.residual) + I(t.change) * I(ball))).hi <= ball) {
      t.error = (I(smallest) / (I(1) - q)).hi;
      t.holds = (I(2) * I(t.moved) + I(t.error)).hi <= ball;
      break;
    }
    ball = q.hi < 1e6 ? ball * std::min(0.9, 0.8 / q.hi) : ball / 1000;
    if (ball < smallest)
      return refuse(fmt::format("no ball around the state is small enough for the Hessian to keep the sign of its eigenvalues "
                                "(the one next to zero is about {:.2g}) and large enough for the residual", spectrum.estimate));
  }
  if (!t.holds)
    return refuse(fmt::format("the state is {:.2g} away from an equilibrium that is the only one in a ball of radius {:.2g}, "
                              "and not near its middle", t.moved, t.radius));
  bound_gaps(s, t);
  return t;
}

}  // namespace elamin::proof
