#pragma once
// Where a rigid body is and how it moves.
#include "core/exact.hpp"
#include "laws/rounded/shape.hpp"

#include <Eigen/Geometry>

namespace elamin {

/// Position of the origin of the body's frame and its rotation: a point r of the body is at p = x + R r. Unit
/// quaternion.
struct Pose {
  ExactVector position;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// exp([θ]×) as a quaternion: the rotation by |θ| about θ; good for any θ, also 0.
inline Eigen::Quaterniond quaternion(const Vec3& theta) {
  const double angle = theta.norm(), half = angle / 2;
  const Vec3 axis = (angle > 0 ? std::sin(half) / angle : 0.5) * theta;
  return {std::cos(half), axis.x(), axis.y(), axis.z()};
}

/// The least rotation that takes the direction of a to that of b, a, b ≠ 0; of opposite ones any.
inline Eigen::Quaterniond shortest_rotation(const Vec3& a, const Vec3& b) {
  const Vec3 across = a.cross(b);
  const double sine = across.norm();
  return quaternion(std::atan2(sine, a.dot(b)) * (sine > 0 ? Vec3(across / sine) : a.unitOrthogonal()));
}

/// The pose moved by dx and then rotated by θ about its own position: x + dx, exp([θ]×) R.
inline Pose moved(const Pose& pose, const Vec3& dx, const Vec3& theta) {
  return {pose.position + ExactVector{dx, Vec3::Zero()}, (quaternion(theta) * pose.rotation).normalized()};
}

/// A body of a shape at a pose. The shape outlives it.
struct RoundedBody {
  const RoundedShape* shape = nullptr;
  Pose pose;
};

// What pushes and turns it.

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
