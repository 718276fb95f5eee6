#pragma once
// That near a state there is exactly one equilibrium, and how many negative eigenvalues its Hessian has: proven, or not.
#include "proof/structure.hpp"

namespace elamin::proof {

/// A contact at the equilibrium: its gap is in an interval of one sign, or it is not told. Of a wall the second particle is −1.
struct GapBound { std::array<int, 2> particles; Interval<double> gap; };

/// Let M be a matrix of doubles near the Hessian at the state, x̄ the centre of a ball, β ≥ ‖M⁻¹‖ (`Spectrum`), γ ≥ ‖∇E(x̄)‖ and
/// ω ≥ ‖H(x) − M‖ for all x in the ball |x − x̄| ≤ ρ. Where  q = β ω < 1  and  β (γ + ω ρ) ≤ ρ,  x − M⁻¹ ∇E(x) maps the ball into itself
/// and contracts it by q: in the ball is exactly one equilibrium, it is within r = β γ/(1 − q) of x̄, and as no eigenvalue of H in the
/// ball comes nearer to zero than 1/β − ω, the Hessian has everywhere in it as many negative eigenvalues as M. Norms are Euclidean, over
/// the free dofs. The energy need only have continuous second derivatives, which it has where a contact opens.
/// Sources: Kantorovich 1948; Rump 2010, "Verification methods", Acta Numerica 19, section 13.
struct Theorem {
  bool holds = false;
  std::string why_not;                         // a sentence
  State centre;                                // x̄: the state after a few steps of Newton's method in 113 bits
  int negative = 0;
  double shift = 0, inverse = 0;               // σ, β
  double residual = 0, change = 0;             // γ, ω
  double radius = 0, error = 0;                // ρ, r
  double moved = 0;                            // ≥ |x̄ − state|
  std::vector<GapBound> closed, open, undecided;   // of all that are within Structure::reach
};

/// Looks for the largest ball that the bounds allow. With 2 |x̄ − state| + r ≤ ρ the equilibrium is the only one within ρ − |x̄ − state| of
/// the state; else it is told not to hold, too.
Theorem prove(const Structure& structure, const State& state);

}  // namespace elamin::proof
