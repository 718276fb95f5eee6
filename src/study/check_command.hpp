#pragma once
#include "input/problem.hpp"
#include "input/settings.hpp"

#include <string>
#include <vector>

namespace elamin {

/// What is understood of a problem: particles, dofs, stiffnesses, effective lengths between the clamps, contact laws, walls and
/// overlaps, groups, rigid motions left free, stages; a line each.
std::string describe(const Problem& problem, const Model& model);

/// `elamin check`: reads and checks a problem file and all runs of its sweep, and prints what was understood of the first one.
/// Throws InputError with every mistake.
void check_command(const std::string& file, const std::vector<Setting>& settings);

}  // namespace elamin
