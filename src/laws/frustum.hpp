#pragma once
// Cylinders and cones in the half-plane through their axis: a trapezoid, and points by their distance from the axis.
#include "core/exact.hpp"
#include "laws/region.hpp"

#include <algorithm>

namespace elamin {

/// x − face; a face at infinity is infinitely far.
inline Exact offset(Exact x, double face) { return std::isfinite(face) ? x + (-face) : Exact{-face, 0}; }

/// A point of the half-plane.
struct AxialPoint {
  Exact rho;                                   // distance from the axis, ≥ 0
  Exact above_lo, above_hi;                    // z − lo, z − hi
  Vec3 outward = Vec3::Zero();                 // unit, away from the axis; zero on it
  Vec3 along = Vec3::Zero();                   // unit, along the axis
};

/// Cylinder or cone: in the half-plane its side runs from (radius_lo, lo) to (radius_hi, hi).
/// A cone that never ends has no slope: it is the cylinder of its first radius.
struct Frustum {
  double lo, hi, radius_lo, radius_hi;
  bool straight;                               // a cylinder; else
  Exact rise, height, slant;                   // ΔR = radius_hi − radius_lo, L = hi − lo, S = √(ΔR² + L²)

  explicit Frustum(const Region& r) : lo(r.axial_lo), hi(r.axial_hi) {
    const bool cone = r.shape == Shape::cone;
    straight = !cone || r.radius_lo == r.radius_hi || !std::isfinite(lo) || !std::isfinite(hi);
    radius_lo = cone ? r.radius_lo : r.radius;
    radius_hi = straight ? radius_lo : r.radius_hi;
    if (straight) return;
    rise = two_sum(radius_hi, -radius_lo), height = two_sum(hi, -lo);
    slant = square_root(rise * rise + height * height);
  }

  /// S times the signed distance from the line of the side, positive outside: (ρ − radius_lo) L − (z − lo) ΔR; of a
  /// cylinder ρ − R.
  Exact excess(const AxialPoint& p) const {
    const Exact a = p.rho + (-radius_lo);
    return straight ? a : a * height - p.above_lo * rise;
  }

  /// Positive inside, negative outside, zero on the surface.
  double depth(const AxialPoint& p) const { return std::min({p.above_lo.hi, -p.above_hi.hi, -excess(p).hi}); }
};

/// x in the half-plane of this cylinder or cone.
inline AxialPoint axial_point(const Region& r, const ExactVector& x) {
  ExactVector d = x - ExactVector{r.center, Vec3::Zero()};
  d.set(r.axis, {});
  AxialPoint p;
  p.rho = length(d);
  p.above_lo = offset(x[r.axis], r.axial_lo), p.above_hi = offset(x[r.axis], r.axial_hi);
  if (p.rho.hi > 0) p.outward = d.hi / p.rho.hi;
  p.along[r.axis] = 1;
  return p;
}

/// Of any region: positive inside, negative outside, zero on the surface; no distance.
double depth(const Region& r, const ExactVector& x);

/// Whether x is on this side of the surface, or on the surface itself, which belongs to both.
inline bool on_side(const Region& r, bool inside, const ExactVector& x) { return inside ? depth(r, x) >= 0 : depth(r, x) <= 0; }

}  // namespace elamin
