#include "laws/rounded/rigid_step.hpp"

#include "core/dense.hpp"

namespace elamin {

namespace {

Vec3 angular_velocity(const Eigen::Quaterniond& q, const RigidMass& m, const Vec3& L) {
  return q * (m.inverse_inertia * (q.conjugate() * L));
}

/// norm(q + h ω q), ω as the quaternion (0, ω).
Eigen::Quaterniond turned(const Eigen::Quaterniond& q, const Vec3& omega, double h) {
  const Eigen::Quaterniond rate = Eigen::Quaterniond(0, omega.x(), omega.y(), omega.z()) * q;
  return Eigen::Quaterniond(q.coeffs() + h * rate.coeffs()).normalized();
}

}  // namespace

RigidMass::RigidMass(double m, const Mat3& inertia) : mass(m) {
  const EigenPairs principal = symmetric_eigen(inertia);
  const Vec3 moments = principal.values;
  for (int k = 0; k < 3; ++k) {
    if (!(moments[k] > 1e-7 * moments[2])) continue;
    const Vec3 axis = principal.vectors.col(k);
    inverse_inertia += axis * axis.transpose() / moments[k];
  }
}

BodyMotion RigidState::motion(const RigidMass& m) const { return {velocity, angular_velocity(pose.rotation, m, angular_momentum)}; }

void kick(RigidState& s, const RigidMass& m, const Wrench& w, double dt) {
  s.velocity += dt / 2 / m.mass * w.force;
  s.angular_momentum += dt / 2 * w.torque;
}

void drift(RigidState& s, const RigidMass& m, double dt) {
  s.pose.position = s.pose.position + ExactVector{dt * s.velocity, Vec3::Zero()};
  const Eigen::Quaterniond q = s.pose.rotation;
  const Vec3& L = s.angular_momentum;
  const Vec3 omega = angular_velocity(q, m, L);
  const Eigen::Quaterniond full = turned(q, omega, dt / 2), quarter = turned(q, omega, dt / 4);
  const Eigen::Quaterniond half = turned(quarter, angular_velocity(quarter, m, L), dt / 4);
  s.pose.rotation = Eigen::Quaterniond(2 * half.coeffs() - full.coeffs()).normalized();
}

}  // namespace elamin
