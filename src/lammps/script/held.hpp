#pragma once
// What holds particles in a run.
#include "lammps/script/world.hpp"

#include <map>
#include <vector>

namespace elamin::script {

/// The particles of a run that begins that something holds, as indices of World::atoms in rising order; of two fixes on one coordinate the later one
/// has the last word.
std::map<Held, std::vector<int>> held_in(const World& world, const Run& run);

}  // namespace elamin::script
