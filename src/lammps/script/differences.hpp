#pragma once
// Where LAMMPS does something else than a script seems to say, or than can be said here.
#include "lammps/script/world.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin::script {

/// A sentence at its place: to know, or, with the name of a command, why that cannot be taken.
struct Difference { Where where; std::string refused, what; };

/// Of a run.
std::vector<Difference> differences(const World& world, const Run& run);

/// On the length of what is clamped by two particles or more, if there is such.
std::optional<Difference> clamp(const World& world, const Run& run);

}  // namespace elamin::script
