#pragma once
// From the tables of structures to particles, bonds and angles.
#include "model/model.hpp"
#include "input/mistakes.hpp"
#include "input/problem.hpp"

#include <string>
#include <vector>

namespace elamin {

/// Adds beams, loops, sheets and grains, in this order, to what the model holds. One that cannot be built is told and
/// its name goes to left_out. False, and nothing is added, if they are too many for this machine.
bool add_structures(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes);

/// Where the table of a structure stands.
const TablePlace& place_of(const Problem& problem, const Structure& structure);

}  // namespace elamin
