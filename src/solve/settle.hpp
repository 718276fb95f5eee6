#pragma once
// Minima of packings: many loose grains that fall, roll, and open and close contacts by the hundred.
#include "solve/newton.hpp"

namespace elamin {

/// How many grains of the model are free and held by no bond: a packing, if they are many.
int unbonded_grains(const Energy& energy);

/// Minimises where contacts of loose grains are far stiffer than what presses on them: with their moduli lowered to where grains overlap by a
/// hundredth of their size, then tenfold again and again up to what they are, each time from near the minimum before; at the end by Newton's method, whose
/// `newton.minimise` decides what is converged. Each descent takes steps p of (H + τI) p = −g with the τ that makes H + τI positive definite and keeps every
/// step within a part of a diameter, shorter where the energy does not fall as predicted below that of a few steps before (a trust region: Nocedal & Wright 2006, §4.1, with the shift of Levenberg
/// and Marquardt for its radius). For models without bodies and without hard contacts. Not converged after `most` steps of one descent.
[[nodiscard]] Report settle(Newton& newton, State& state, int most);

}  // namespace elamin
