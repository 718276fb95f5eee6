#pragma once
// Per-particle and per-bond values of a structure from a table.
#include "input/mistakes.hpp"
#include "model/model.hpp"

#include <string>

namespace elamin {

/// Puts the columns of a table of commas into a structure of the model, row k to its k-th particle: diameter and density; of a row of
/// particles bond_stiffness and rest_length of the bond behind it, angle_stiffness of the angle in whose middle it is (an empty cell:
/// as it was). Mistakes: what is wrong with the file, the number of its rows, a value that is not positive or belongs to nothing.
void add_own_values(const TablePlace& place, const std::string& file, const Structure& structure, Model& model, Mistakes& mistakes);

}  // namespace elamin
