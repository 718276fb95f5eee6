#pragma once
// The parts of check_problem, and the names that they share.
#include "input/names.hpp"

namespace elamin {

/// Beams, loops, sheets, grains: what goes together, their names, how many they are together.
void check_structures(Problem& problem, Names& names, Mistakes& mistakes);

/// Rigid bodies.
void check_bodies(Problem& problem, Names& names, Mistakes& mistakes);

/// What particles bodies carry, and the laws and walls of bodies.
void check_rounded(Problem& problem, Names& names, Mistakes& mistakes);

/// How a support holds and moves.
void check_support(const Problem& problem, SupportTable& s, Mistakes& mistakes);

/// Groups and how they choose, in the order of the file.
void check_groups(Problem& problem, Names& names, Mistakes& mistakes);

/// Connections, contacts and walls.
void check_interactions(Problem& problem, Names& names, Mistakes& mistakes);

/// Loads, gravity, pressures, changes; the names of conditions, and those that [path] parameter chooses.
void check_loads(Problem& problem, Names& names, Mistakes& mistakes);

/// The path, its stages and the events that are looked for on it.
void check_path(Problem& problem, Mistakes& mistakes);

/// What is observed and expected.
void check_results(Problem& problem, Names& names, Mistakes& mistakes);
void check_expectations(Problem& problem, Mistakes& mistakes);

}  // namespace elamin
