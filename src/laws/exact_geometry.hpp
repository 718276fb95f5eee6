#pragma once
// Lengths and cross products with about 30 digits: what is left when nearly equal ones are subtracted is still good.
#include "core/exact.hpp"

namespace elamin {

/// √a for a ≥ 0, relative error about 2⁻¹⁰⁰ (one Newton step from the rounded root); 0 for a ≤ 0.
inline Exact root(Exact a) {
  if (!(a.hi > 0)) return {};
  const double r = std::sqrt(a.hi);
  return quick_two_sum(r, (a - two_product(r, r)).hi / (2 * r));
}

/// |a|.
inline Exact length(const ExactVector& a) { return root(dot(a, a)); }

/// a × b, each component to about 30 digits of |a||b|.
inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return exact_vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

}  // namespace elamin
