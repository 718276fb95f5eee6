#pragma once
// Equilibria in which given hard contacts are closed: smooth, unlike the question which ones are.
#include "solve/factors.hpp"
#include "solve/report.hpp"

#include <limits>

namespace elamin {

/// Newton's method on   ∂L/∂q = ∂E/∂q − Jᵀf = 0,  c(q) = 0   for the contacts of State::hard, L = E − Σ f c, J = ∂c/∂q:
///   [ H   Jᵀ ] [  p ]   [ −∂L/∂q ]
///   [ J  −δ  ] [ −Δf ] = [   −c   ]
/// H the Hessian of L; δ, small, makes forces unique where contacts are redundant; it does not move the solution, where Δf = 0.
/// Without hard contacts it is Newton's method on ∂E/∂q = 0.
/// Source: Nocedal & Wright 2006, Numerical Optimization, §16.1, §18.1; Wächter & Biegler 2006 (δ).
class ContactEquilibrium {
 public:
  static constexpr double anywhere = std::numeric_limits<double>::infinity();
  explicit ContactEquilibrium(Energy& energy) : energy_(energy), factors_(energy) {}

  /// The stationary point with these contacts closed, forces of any sign. Not converged if the steps do not shrink. `from`: where a
  /// prediction led here from (see Energy::evaluate).
  /// `reach`: how far coordinates may move [length]. Ends as close as rounding allows, once the residual is below the tolerance.
  Report settle(State& state, double tolerance, const State* from = nullptr, double reach = anywhere);

  /// The same, and the right contacts: those that would pull are let go, those that would overlap are taken in, until no gap is
  /// negative and no force either, within rounding; State::hard then holds those that bear a force.
  Report correct(State& state, double tolerance, const State* from = nullptr, double reach = anywhere);

  /// Numbers of eigenvalues below zero and at zero of the Hessian of L among the motions that keep the closed gaps: stability, to
  /// second order.
  Inertia inertia(const State& state);

  /// How the state moves with the load factor: (∂q/∂λ, ∂f/∂λ), the contacts staying closed.
  struct Tangent { Vector q, force; };
  Tangent tangent(const State& state);

  /// The `count` lowest eigenpairs of the Hessian of L among the motions that keep the closed gaps, by block inverse iteration; good
  /// to about 1e-6 of the largest of them.
  EigenPairs lowest(const State& state, int count);

 private:
  struct Step { Vector p, force; };
  void linearise(const State& state, const State* from);
  bool factorize(double shift);
  bool factorize_near();
  Step solve(const Vector& b, const Vector& c);
  double worst_gap(const State& state) const;

  Energy& energy_;
  Factors factors_;                              // for its zero_level
  PivotedFactor pivoted_;
  int version_ = -1;                             // of the pattern that matrix_ was made for, with these contacts
  std::vector<HardForce> closed_;
  std::vector<HardGap> gaps_;                    // theirs, at the state last linearised
  SparseMatrix matrix_;
  double scale_ = 1;                             // of J's rows, so that they are like H's
};

}  // namespace elamin
