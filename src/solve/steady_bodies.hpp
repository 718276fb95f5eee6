#pragma once
// What keeps rigid bodies from drifting while an equilibrium is looked for.
#include "energy/energy.hpp"

namespace elamin {

/// Adds |g|∞/(size/5) to the diagonal of the last evaluation's Hessian at the bodies' dofs: bodies slide and spin where nothing but
/// rounding, or a force that the next step takes away, holds them; so none drifts farther than a fifth of its size a step. It
/// vanishes with the residual: Newton's method stays quadratic in the end (Levenberg and Marquardt's damping). Idle dofs have a
/// stiffness of their own. g: the gradient (dofs).
void steady_bodies(Energy& energy, const Vector& g);

}  // namespace elamin
