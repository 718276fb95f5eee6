#include "model/geometry.hpp"

#include <array>
#include <cmath>

namespace elamin {
namespace {

/// 1/k! for k up to 28: (π/4)^30/30! is below 1e-35.
const std::array<Exact, 29>& inverse_factorials() {
  static const std::array<Exact, 29> table = [] {
    std::array<Exact, 29> t;
    t[0] = exact(1);
    for (int k = 1; k < 29; ++k) t[k] = t[k - 1] / exact(k);
    return t;
  }();
  return table;
}

/// Σ (−x²)^m / (2m + first)!, by Horner's rule: cos x for first = 0, sin x / x for first = 1.
Exact series(Exact x, int first) {
  const std::array<Exact, 29>& inverse = inverse_factorials();
  const Exact square = -(x * x);
  Exact sum = inverse[28 - first];
  for (int k = 26 - first; k >= first; k -= 2) sum = sum * square + inverse[k];
  return sum;
}

}  // namespace

Exact norm(const ExactVector& d) {                 // scaled by a power of 2 so that no square leaves the doubles' range
  if (!d.hi.allFinite()) return {d.hi.norm(), 0};
  const double largest = d.hi.cwiseAbs().maxCoeff();
  if (largest == 0) return {};
  const int exponent = std::ilogb(largest);
  ExactVector unit;
  for (int c = 0; c < 3; ++c) unit.set(c, {std::ldexp(d.hi[c], -exponent), std::ldexp(d.lo[c], -exponent)});
  const Exact size = square_root(dot(unit, unit));
  return {std::ldexp(size.hi, exponent), std::ldexp(size.lo, exponent)};
}

Vec3 scaled(const Vec3& v) {
  const int exponent = std::ilogb(v.cwiseAbs().maxCoeff());
  return {std::ldexp(v[0], -exponent), std::ldexp(v[1], -exponent), std::ldexp(v[2], -exponent)};
}

CosineSine cosine_sine(Exact turns) {
  const double quarters = std::nearbyint(4 * turns.hi);
  const Exact x = exact_pi * exact(2) * (turns - exact(quarters / 4));   // |x| ≤ π/4
  const Exact c = series(x, 0), s = x * series(x, 1);
  switch ((static_cast<long long>(quarters) % 4 + 4) % 4) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

Exact turns(double angle) {
  const double twelfth = exact_pi.hi / 6, whole = std::round(angle / twelfth);
  if (std::abs(angle - whole * twelfth) <= 4 * epsilon * std::abs(angle)) return exact(std::fmod(whole, 12)) / exact(12);
  return exact(angle) / (exact_pi * exact(2));
}

double angle_at(const ExactVector& at, const ExactVector& a, const ExactVector& b) {
  const ExactVector to_a = a - at, to_b = b - at;
  if (to_a.hi.isZero(0) || to_b.hi.isZero(0)) return exact_pi.hi;
  const Vec3 u = scaled(to_a.hi).normalized(), w = scaled(to_b.hi).normalized();
  const double angle = 2 * std::atan2((u - w).norm(), (u + w).norm());
  return exact_pi.hi - angle < 1e-9 ? exact_pi.hi : angle;
}

ExactVector Frame::point(const Vec3& center, Exact u, Exact v, Exact w) const {
  ExactVector x;
  for (int c = 0; c < 3; ++c) x.set(c, u * e1[c] + v * e2[c] + w * n[c] + center[c]);
  return x;
}

Frame frame_of(const Vec3& normal) {
  const Vec3 direction = scaled(normal);
  const Exact size = norm(exact(direction));
  Frame f;
  for (int c = 0; c < 3; ++c) f.n.set(c, exact(direction[c]) / size);
  // e1 = x − n_x m, e2 = y − n_y m with m = (n_x, n_y, 1 + n_z)/(1 + n_z). Where 1 + n_z cancels,
  // n_x n_y/(1 + n_z) = p q (1 − n_z) with the unit vector (p, q) along (n_x, n_y).
  Exact xx, xy, yy;
  if (direction[2] >= 0) {
    const Exact below = f.n[2] + 1;
    xx = f.n[0] * f.n[0] / below, xy = f.n[0] * f.n[1] / below, yy = f.n[1] * f.n[1] / below;
  } else {
    Vec3 across(direction[0], direction[1], 0);
    across = across.isZero(0) ? Vec3::UnitY() : scaled(across);
    const Exact root = norm(exact(across)), more = exact(1) - f.n[2];
    const Exact p = exact(across[0]) / root, q = exact(across[1]) / root;
    xx = p * p * more, xy = p * q * more, yy = q * q * more;
  }
  f.e1.set(0, exact(1) - xx), f.e1.set(1, -xy), f.e1.set(2, -f.n[0]);
  f.e2.set(0, -xy), f.e2.set(1, exact(1) - yy), f.e2.set(2, -f.n[1]);
  return f;
}

}  // namespace elamin
