#pragma once
// The time step of a rigid body.
#include "laws/rounded/lammps_rules.hpp"

namespace elamin {

/// Mass and inverse inertia of a body, in its frame. A principal moment below 1e-7 of the largest counts as zero: about
/// that axis the body never spins (a rod, a point).
struct RigidMass {
  double mass = 1;
  Mat3 inverse_inertia = Mat3::Zero();

  RigidMass(double m, const Mat3& inertia);
};

/// Pose, velocity and angular momentum (axes of space, about the position).
struct RigidState {
  Pose pose;
  Vec3 velocity = Vec3::Zero(), angular_momentum = Vec3::Zero();

  /// With ω = R I⁻¹ Rᵀ L.
  BodyMotion motion(const RigidMass& m) const;
};

/// v += dt/2 F/m,  L += dt/2 T.
void kick(RigidState& s, const RigidMass& m, const Wrench& w, double dt);

/// x += dt v and the change of the rotation q by L, two half steps beside a full one, extrapolated (Richardson):
///   q_full = norm(q + dt/2 ω q),   q_half = norm(q + dt/4 ω q)
///   ω′ = I(q_half)⁻¹ L,            q_half ← norm(q_half + dt/4 ω′ q_half)
///   q ← norm(2 q_half − q_full)
/// kick, drift, new forces (with the velocities of the half step), kick: one step of velocity Verlet.
/// Source: LAMMPS 29 Sep 2021, fix nve/body.
void drift(RigidState& s, const RigidMass& m, double dt);

}  // namespace elamin
