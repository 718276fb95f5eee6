#pragma once
// The parts of what moves, for an Archive.
#include "dynamics/motion.hpp"
#include "laws/rounded/rigid_step.hpp"
#include "model/carry.hpp"

namespace elamin {

inline void carry(Archive& archive, BodyMotion& x) {
  auto& [velocity, angular_velocity] = x;
  archive(velocity, angular_velocity);
}
inline void carry(Archive& archive, Wrench& x) {
  auto& [force, torque] = x;
  archive(force, torque);
}
inline void carry(Archive& archive, RigidState& x) {
  auto& [pose, velocity, angular_momentum] = x;
  archive(pose, velocity, angular_momentum);
}
inline void carry(Archive& archive, Motion& x) {
  auto& [state, velocity, angular_velocity, force, body_velocity, angular_momentum, body_force, torque, step, time, work, dissipation] = x;
  archive(state, velocity, angular_velocity, force, body_velocity, angular_momentum, body_force, torque, step, time, work, dissipation);
}

}  // namespace elamin
