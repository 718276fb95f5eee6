#pragma once
// How a rigid body moves, and what pushes and turns it.
#include "core/types.hpp"

namespace elamin {

/// How a body moves: velocity of its position and angular velocity.
struct BodyMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  /// Of the point at `arm` from the position.
  Vec3 at(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }
};

/// Force on a body and torque about its position.
struct Wrench {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  void add(const Vec3& f, const Vec3& arm) { force += f, torque += arm.cross(f); }
  void add(const Wrench& w) { force += w.force, torque += w.torque; }
  /// What it does to a body that moves so: −power is what it takes out.
  double power(const BodyMotion& m) const { return force.dot(m.velocity) + torque.dot(m.angular_velocity); }
};

}  // namespace elamin
