#pragma once
// What the lines of pair_coeff and special_bonds say together.
#include "lammps/script/world.hpp"

#include <array>
#include <vector>

namespace elamin::script {

/// The style of pair_style that has laws of this kind; there is one at least.
const PairStyle* style_of(const Run& run, PairCoefficient::Law law);

/// Pairs of unlike `types` that no line names: mixed of those of like types, as LAMMPS does.
std::vector<PairCoefficient> mixed(const Run& run, const std::vector<int>& types);

/// Whether such a pair feels nothing.
bool nothing(const PairCoefficient& c);

/// How many bonds the pairs are apart, at most, that feel nothing by the weights of special_bonds; −1: no number says it. `partial`
/// becomes true where a weight is neither 0 nor 1.
int excluded(const std::array<double, 3>& lj, const std::array<double, 3>& coul, bool granular, bool& partial);

}  // namespace elamin::script
