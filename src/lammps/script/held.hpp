#pragma once
// What holds particles in a run.
#include "lammps/script/world.hpp"

#include <array>
#include <map>
#include <tuple>
#include <vector>

namespace elamin::script {

/// What holds a particle along its coordinates, and how fast.
struct Held {
  std::array<bool, 3> directions{};
  Vec3 velocity = Vec3::Zero();
  int fix = -1;                               // of Run::fixes; −1: nothing integrates it
  auto key() const { return std::tuple(fix, directions, velocity[0], velocity[1], velocity[2]); }
  bool operator<(const Held& o) const { return key() < o.key(); }
};

/// The particles of a run that something holds, as indices of World::atoms in rising order; of two fixes on one coordinate the later one
/// has the last word.
std::map<Held, std::vector<int>> held_in(const World& world, const Run& run);

}  // namespace elamin::script
