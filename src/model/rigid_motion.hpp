#pragma once
// Which rigid motions the supports leave free, by name.
#include "model/model.hpp"

namespace elamin {

/// A rigid velocity of some particles, t + ω × (x − x̄), that moves no prescribed coordinate.
struct RigidMotion {
  std::string name;               // "translation of 'column' along x", "rotation of 'column' about z through (0, 0, 0)"
  bool translation = false;
  int particle = 0;               // the first one of the part that moves
  Field velocity;                 // 3 × particles, zero outside of the structure
};

/// The rigid motions of every part that is glued together (connected by bonds and angles), at the given state, that
/// the supports leave free. Motions that move nothing, as turning a straight row about its own line, do not count.
std::vector<RigidMotion> free_rigid_motions(const Model& model, const State& state);

/// The parts themselves: for every particle the number of its part, from 0 in the order of the first particle.
std::vector<int> connected_parts(const Model& model);

}  // namespace elamin
