#pragma once
// The parts of a state, for an Archive.
#include "core/archive.hpp"
#include "model/state.hpp"

namespace elamin {

inline void carry(Archive& archive, ExactVector& x) {
  auto& [hi, lo] = x;
  archive(hi, lo);
}
inline void carry(Archive& archive, Pose& x) {
  auto& [position, rotation] = x;
  archive(position, rotation);
}
inline void carry(Archive& archive, HardForce& x) {
  auto& [particle, other, wall, face, force] = x;
  archive(particle, other, wall, face, force);
}
inline void carry(Archive& archive, State& x) {
  auto& [position, low, bodies, load_factor, hard] = x;
  archive(position, low, bodies, load_factor, hard);
}

}  // namespace elamin
