#pragma once
#include "laws/radial.hpp"
#include "laws/wall_gap.hpp"

namespace elamin {

/// Hard contact of two spheres, gap c = r − ρ ≥ 0, r = |x₁ − x₀|, in the Lagrangian  U = −f c  with its multiplier, the force f ≥ 0
/// with which they push each other apart.
///   ∇₁U = −f n = −∇₀U,   n = (x₁ − x₀)/r,   ∇₁∇₁U = −f/r (I − n nᵀ) = ∇₀∇₀U = −∇₀∇₁U
/// Where the centres meet, r = 0, there is no direction: no force.
/// The gap is formed as (r² − ρ²)/(r + ρ) with r² − ρ² exact: it keeps all its digits.
/// Source: Nocedal & Wright 2006, Numerical Optimization, §12.3.
struct HardContact {
  static constexpr int sites = 2;
  double force;                                // f [force]
  double contact_distance;                                // ρ [length]

  double value(const Points<2>& x) const { return -force * gap(x); }

  Local<2> derivatives(const Points<2>& x) const { return radial(x.edge(0, 1).hi, value(x), -force, 0); }

  /// c = r − ρ [length]
  double gap(const Points<2>& x) const {
    const ExactVector d = x.edge(0, 1);
    const double sum = d.hi.norm() + contact_distance;
    return sum > 0 ? (dot(d, d) - two_product(contact_distance, contact_distance)).value() / sum : 0.0;
  }
};

/// Hard contact of a sphere of this radius with a face of a wall, gap c = d − radius ≥ 0, d the distance of the centre from the face
/// (see wall_gap.hpp), in the Lagrangian:  U = −f c,  ∇U = −f ∇d,  ∇²U = −f ∇²d.
/// +inf where the wall does not see the sphere: there is no gap to keep.
struct HardWall {
  static constexpr int sites = 1;
  double force;                                // f [force]
  Region region;                               // where the wall is now
  bool inside = true;
  double radius = 0;                           // of the sphere [length]
  int face = 0;

  double value(const Points<1>& x) const {
    WallGap g;
    return find(x, g) ? force * g.overlap : infinity;
  }

  Local<1> derivatives(const Points<1>& x) const {
    Local<1> u;
    WallGap g;
    if (!find(x, g)) {
      u.value = infinity;
      return u;
    }
    u.value = force * g.overlap;
    u.gradient = -force * g.distance.gradient.head<3>();
    u.hessian = -force * g.distance.hessian.topLeftCorner<3, 3>();
    return u;
  }

  /// The gap to the face at x, with the wall's radius as a fourth coordinate; false where the wall does not see the sphere.
  bool find(const Points<1>& x, WallGap& gap) const {
    constexpr double anywhere = infinity;
    for (const WallGap& g : wall_gaps(region, inside, false, {x.position.col(0), x.low.col(0)}, radius, anywhere))
      if (g.face == face) {
        gap = g;
        return true;
      }
    return false;
  }
};

static_assert(Law<HardContact> && Law<HardWall>);

}  // namespace elamin
