#pragma once
// What changes in a problem file where the spacing of its structures is divided.
#include "input/problem.hpp"
#include "input/settings.hpp"
#include "model/model.hpp"

namespace elamin {

/// The keys that put particles `by` times as near to each other: a row of n bonds gets by·n, K and B of its bonds and angles that are given become by times as
/// large (EA = 2 K r₀, EI = B r₀), of a sheet they stay; masses per length or area, thickness and diameters stay, and so do grains and bodies. Particle i of a row
/// is now by·i, of a group that is counted or has ids what lies between neighbours belongs to it, too; where a support holds neighbours of a row, the end of what
/// is held, the middle of a bond, stays there. Mistakes: what has no place at the new spacing.
std::vector<Setting> finer_structure(const Problem& problem, const Model& model, int by, Mistakes& mistakes);

/// The keys that then keep the sum of every dead load, but for those whose value has changed already. Mistakes: a group in which a particle was that is not in it
/// now, or the other way round.
std::vector<Setting> finer_loads(const Problem& coarse, const Model& coarse_model, const Problem& fine, const Model& fine_model, int by, Mistakes& mistakes);

}  // namespace elamin
