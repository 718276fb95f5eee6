#pragma once
// What acts between moving rounded bodies besides a potential: damping and friction at its contacts.
#include "laws/rounded/lammps_rules.hpp"
#include "laws/rounded/pair_view.hpp"

#include <algorithm>

namespace elamin {

/// At a contact of RoundedMulti or RoundedClosest, v the velocity of A against B at its point, v_n = (v·n) n, v_t = v − v_n:
///   force on A  = −c_n v_n                                                   for δ ≤ r_c if `apart`, else for δ ≤ 0
///                 −c_t v_t − min(μ k_n |δ|, η |v_t|) v_t/|v_t|               for δ ≤ 0
/// times the contact's weight; −that on B, at the same point, so that momentum and angular momentum stay. Friction of sliding
/// from the first touch, without memory; η > 0 takes the place of its jump at v_t = 0. It never gains energy.
/// Source: LAMMPS, manual of pair_style body/rounded/polyhedron (`apart` as printed; the program damps for δ ≤ 0 only and
/// has no tangential friction: LammpsRules).
struct RoundedFriction {
  double normal_damping = 0;                   // c_n [force·time/length]
  double tangential_damping = 0;               // c_t [force·time/length]
  double friction = 0;                         // μ
  double stiffness = 0;                        // k_n [force/length]
  double slip = 0;                             // η [force·time/length]
  bool apart = true;

  /// On A and B. The contacts are those with gap ≤ r_c.
  std::array<Wrench, 2> at(const RoundedContact& c, const Pose& a, const Pose& b, const BodyMotion& va, const BodyMotion& vb) const {
    std::array<Wrench, 2> on;
    const Vec3 arm_a = c.point - a.position.hi, arm_b = c.point - b.position.hi;
    const Vec3 v = va.at(arm_a) - vb.at(arm_b), vn = v.dot(c.normal) * c.normal, vt = v - vn;
    Vec3 f = Vec3::Zero();
    if (apart || c.gap <= 0) f -= normal_damping * vn;
    if (c.gap <= 0) {
      const double sliding = vt.norm(), most = friction * stiffness * -c.gap;
      f -= tangential_damping * vt;
      if (sliding > 0) f -= std::min(most / sliding, slip) * vt;
    }
    on[0].add(c.weight * f, arm_a);
    on[1].add(-c.weight * f, arm_b);
    return on;
  }
};

}  // namespace elamin
