#pragma once
#include "input/settings.hpp"

#include <string>
#include <vector>

namespace elamin {

/// `elamin check`: reads and checks a problem file and all runs of its sweep, and prints what was understood: particles,
/// dofs, stiffnesses, effective lengths between the clamps, contact laws, walls and overlaps, rigid motions left free.
/// Throws InputError with every mistake.
void check_command(const std::string& file, const std::vector<Setting>& settings);

}  // namespace elamin
