#pragma once
// Equilibria in which given hard contacts are closed: smooth, unlike the question which ones are.
#include "solve/factors.hpp"
#include "solve/report.hpp"

#include <optional>
#include <vector>

namespace elamin {

/// Newton's method on   ∂L/∂q = ∂E/∂q − Jᵀf = 0,  c(q) = 0   for the contacts of State::hard, L = E − Σ f c, J = ∂c/∂q:
///   [ H   Jᵀ ] [  p ]   [ −∂L/∂q ]
///   [ J  −δ  ] [ −Δf ] = [   −c   ]
/// H the Hessian of L; δ, small, makes forces unique where contacts are redundant; it does not move the solution, where Δf = 0.
/// Without hard contacts it is Newton's method on ∂E/∂q = 0.
/// Source: Nocedal & Wright 2006, Numerical Optimization, §16.1, §18.1; Wächter & Biegler 2006 (δ).
class ContactEquilibrium {
 public:
  static constexpr double anywhere = infinity;
  explicit ContactEquilibrium(Energy& energy) : energy_(energy), factors_(energy) {}

  /// The stationary point with these contacts closed, forces of any sign. Not converged if the steps do not shrink. `from`: where a
  /// prediction led here from (see Energy::evaluate).
  /// `step_bound`: how far coordinates may move [length]. Directions in the columns of `held` (orthonormal, dofs × any number) keep their
  /// value: motions that cost nothing. Ends as close as rounding allows, once the residual is below the tolerance.
  [[nodiscard]] Report settle(State& state, double tolerance, const State* from = nullptr, double step_bound = anywhere, const Eigen::MatrixXd& held = {}) {
    return newton(state, tolerance, from, step_bound, held, nullptr);
  }

  /// The same where a contact changes: the load factor is an unknown too, and what is zero there is the force of `changing`, if it is
  /// among the closed ones, else its gap.
  [[nodiscard]] Report meet(State& state, const HardForce& changing, double tolerance, const State* from, const Eigen::MatrixXd& held) {
    return newton(state, tolerance, from, anywhere, held, &changing);
  }

  /// The stationary point where the coordinates have moved by `amount` [length] along `mode` (dofs, normalised) since `origin`; the load
  /// factor λ is an unknown. `slope` gets dλ/d(amount): at a limit point, where the equations at a given λ are singular and these are not, it is zero.
  [[nodiscard]] Report slide(State& state, const State& origin, const Vector& mode, double amount, double tolerance, const Eigen::MatrixXd& held, double& slope);

  /// A curvature along `mode`, among the motions that keep the closed gaps: κ of  [ K v ; vᵀ 0 ] [ x ; −κ ] = [ 0 ; 1 ],  K the matrix above. It is zero
  /// where K is singular with a critical mode that is not orthogonal to v, and smooth along the branch.   Source: Govaerts 2000, Numerical
  /// Methods for Bifurcations of Dynamical Equilibria, §3.3.
  double curvature(const State& state, const Vector& mode, const Eigen::MatrixXd& held);
  /// Of eigenvalues and curvatures that are no larger rounding may make the sign.
  double zero_level() const { return factors_.zero_level(); }

  /// The same, and the right contacts: those that would pull are let go, those that would overlap are taken in, until no gap is
  /// negative and no force either, within rounding; State::hard then holds those that bear a force.
  [[nodiscard]] Report correct(State& state, double tolerance, const State* from = nullptr, double step_bound = anywhere, const Eigen::MatrixXd& held = {});

  /// Numbers of eigenvalues below zero and at zero of the Hessian of L among the motions that keep the closed gaps: stability, to
  /// second order. All count as zero where there is no factor, or a stop is asked for.
  Inertia inertia(const State& state);

  /// How the state moves with the load factor: (∂q/∂λ, ∂f/∂λ), the contacts staying closed and the directions `held` still.
  struct Tangent { Vector q, force; };
  Tangent tangent(const State& state, const Eigen::MatrixXd& held = {});

  /// The contacts that are closed as the load factor goes on (direction 1) or back (−1) from a state where those in `slack` have
  /// neither a gap nor a force: those of State::hard that are not among them, and of them those that the rates tell,
  ///   ċ ≥ 0,  ḟ ≥ 0,  ċ ḟ = 0,
  /// a linear complementarity problem: all that are wrong change sides, and where that does not lead on the first one alone, which
  /// comes to an end at a stable equilibrium; where that does not either, of few contacts all choices. Nothing if none are right: there
  /// the equilibrium ends.
  /// Source: Júdice & Pires 1994, Computers Ops Res. 21, 587 (block principal pivoting); Murty 1974, Linear Algebra Appl. 9.
  [[nodiscard]] std::optional<std::vector<HardForce>> onward(State state, const std::vector<HardForce>& slack, double direction);

  /// The `count` lowest eigenpairs of the Hessian of L among the motions that keep the closed gaps, by block inverse iteration; good
  /// to about 1e-6 of the largest of them.
  EigenPairs lowest(const State& state, int count);

 private:
  struct Step { Vector p, force; double border = 0; };         // of the last of the directions held
  [[nodiscard]] Report newton(State& state, double tolerance, const State* from, double step_bound, const Eigen::MatrixXd& held, const HardForce* changing);
  void linearise(const State& state, const State* from, const Eigen::MatrixXd& held = {});
  [[nodiscard]] bool factorize(double shift);
  [[nodiscard]] bool factorize_near(double shift);
  Step solve(const Vector& b, const Vector& c, double along = 0);
  double worst_gap(const State& state) const;
  double rate(const HardGap& gap) const;
  double along(const HardGap& gap, const Vector& p) const;

  Energy& energy_;
  Factors factors_;                              // for its zero_level
  PivotedFactor pivoted_{true};
  int version_ = -1;                             // of the pattern that matrix_ was made for, with these contacts …
  Eigen::MatrixXd borders_;                      // … and so many directions held: with zeros for the contacts
  double border_unit_ = 0;                       // the scale that they have in the factor
  std::vector<HardForce> closed_;
  std::vector<HardGap> gaps_;                    // theirs, at the state last linearised
  SparseMatrix matrix_;
  double scale_ = 1;                             // of J's rows, so that they are like H's
};

}  // namespace elamin
