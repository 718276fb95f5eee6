#pragma once
// What the particles, bonds and angles of a structure have that is theirs alone.
#include "model/model.hpp"

#include <vector>

namespace elamin {

/// Of the k-th particle of a structure, of the bond to the one behind it (behind the last of a ring is the first), and of the angle in
/// whose middle it is. A list may be empty; NaN in it: as it was.
struct OwnValues {
  std::vector<double> diameter, density;                       // [length], [mass/length³]
  std::vector<double> bond_stiffness, rest_length;             // K [force/length], r₀ [length]
  std::vector<double> angle_stiffness;                         // B [energy]
};

/// How many bonds and angles the k-th particle of a structure may give values to: true where there is one.
std::vector<bool> has_bond_behind(const Model& model, const Structure& structure);
std::vector<bool> has_angle_in_the_middle(const Model& model, const Structure& structure);

/// Puts them there; bonds and angles get types for each distinct choice.
void set_own_values(Model& model, const Structure& structure, const OwnValues& values);

}  // namespace elamin
