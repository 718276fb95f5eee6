#pragma once
// How far the load factor of an event may be off by rounding.
#include "path/contact_gap.hpp"
#include "path/equilibrium.hpp"

namespace elamin {

// Each is what the condition of the event misses at the point, and what rounding may hide of it, over its rate by the load factor; NaN where that has none.
// |·|_ε: with ε times the size of a sum that is formed element by element (limits::form_rounding, slope_rounding). g is what is left of the forces,
// and g_r = Σ 2 K r₀ ∇r ε/2 the forces by which rest lengths, which are numbers of the problem, are rounded, all of them alike.

/// Of a limit point with null vector v: (|vᵀg|_ε + |vᵀg_r|)/|vᵀ∂g/∂λ|, as vᵀ(g + H dx + ∂g/∂λ dλ) = vᵀg + vᵀ∂g/∂λ dλ; what the eigenvalue misses moves λ
/// in second order.
[[nodiscard]] double limit_error(Newton& newton, const Equilibrium& at, const Eigen::MatrixXd& modes);

/// Of a branch point: (|vᵀHv|_ε + |dμ| + |dμ_r|)/|dμ/dλ|, the largest of its modes. dμ/dλ = ∇³E v v x' and dμ = ∇³E v v p are central differences of vᵀHv
/// along the branch and along p = −H⁻¹g, −H⁻¹g_r with the modes held, over 1e-4 of `width`, a range of λ around; dμ_r has vᵀ∂H/∂r₀ v besides.
[[nodiscard]] double branch_error(Newton& newton, const Equilibrium& at, const Eigen::MatrixXd& modes, double width);

/// Takes the residual at a located contact, which is as small as its search asks for, down to rounding, with the load factor as it is: what is observed
/// there moves by more than the load factor. False where it cannot be.
bool sharpen(Newton& newton, Equilibrium& at);

/// Of contacts whose gaps vanish: (|gap| + ε |x| + |∇gap·H⁻¹g| + |∇gap·H⁻¹g_r|)/|dgap/dλ|, x the place, the largest of them; `width`: a range of λ over
/// which walls move. NaN of bodies.
[[nodiscard]] double contact_error(Newton& newton, const Equilibrium& at, const ContactSet& changed, double width);

}  // namespace elamin
