#pragma once
// Laws of the difference or of the distance of two sites: their derivatives, once.
#include "laws/law.hpp"

namespace elamin {

/// Of a law of d = x₁ − x₀ alone:  ∇₁U = g = −∇₀U,   ∇₁∇₁U = a n nᵀ + b I = ∇₀∇₀U = −∇₀∇₁U.
inline Local<2> of_difference(double value, const Vec3& g, const Vec3& n, double a, double b) {
  Local<2> u;
  u.value = value;
  u.force_part(1) = g;
  u.force_part(0) = -g;
  Mat3 h = n * n.transpose();
  h *= a;
  h.diagonal().array() += b;
  u.block(0, 0) = u.block(1, 1) = h;
  u.block(0, 1) = u.block(1, 0) = -h;
  return u;
}

/// Of a radial law f(r), r = |d|, n = d/r:  ∇₁U = f′ n,   ∇₁∇₁U = f″ n nᵀ + f′/r (I − n nᵀ). `across` [force/length] stands for f′/r where a law
/// takes another one. Where the sites meet, r = 0, there is no direction: no force, and f″ I.
inline Local<2> radial(const Vec3& d, double value, double first, double second, double across) {
  const double r = d.norm();
  if (r == 0) return of_difference(value, Vec3::Zero(), Vec3::Zero(), 0, second);
  return of_difference(value, first * Vec3(d / r), d / r, second - across, across);
}
inline Local<2> radial(const Vec3& d, double value, double first, double second) {
  const double r = d.norm();
  return radial(d, value, first, second, r > 0 ? first / r : 0.0);
}

}  // namespace elamin
