#pragma once
// Error-free transformations: sums, products and differences that keep what rounding would throw away.
// A pair (hi, lo) stands for the unevaluated sum hi + lo with |lo| ≤ ulp(hi)/2, about 32 digits.
// Always inlined: a call would cost more than they do, and in large units GCC makes calls of them.
// Source: Dekker 1971; Ogita, Rump, Oishi 2005, "Accurate sum and dot product", algorithms 3.1–3.3.
#include "core/types.hpp"

#include <cmath>

namespace elamin {

struct Exact {
  double hi = 0, lo = 0;
  double value() const { return hi + lo; }
};

/// a + b = hi + lo exactly (Knuth).
[[gnu::always_inline]] inline Exact two_sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

/// a + b = hi + lo exactly, for |a| ≥ |b| (Dekker).
[[gnu::always_inline]] inline Exact quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// a · b = hi + lo exactly, barring underflow.
[[gnu::always_inline]] inline Exact two_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

/// a + b, relative error about 2⁻¹⁰⁵ (no cancellation in the tails is lost).
[[gnu::always_inline]] inline Exact operator+(Exact a, Exact b) {
  Exact s = two_sum(a.hi, b.hi);
  const Exact t = two_sum(a.lo, b.lo);
  s = quick_two_sum(s.hi, s.lo + t.hi);
  return quick_two_sum(s.hi, s.lo + t.lo);
}
[[gnu::always_inline]] inline Exact operator-(Exact a) { return {-a.hi, -a.lo}; }
[[gnu::always_inline]] inline Exact operator-(Exact a, Exact b) { return a + (-b); }
[[gnu::always_inline]] inline Exact operator+(Exact a, double b) { return a + Exact{b, 0}; }

/// a · b, relative error about 2⁻¹⁰⁴.
[[gnu::always_inline]] inline Exact operator*(Exact a, Exact b) {
  const Exact p = two_product(a.hi, b.hi);
  return quick_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

/// a / b, relative error about 2⁻¹⁰⁰.
inline Exact operator/(Exact a, Exact b) {
  const double q1 = a.hi / b.hi;
  Exact r = a - Exact{q1, 0} * b;
  const double q2 = r.hi / b.hi;
  r = r - Exact{q2, 0} * b;
  return quick_two_sum(q1, q2) + Exact{r.hi / b.hi, 0};
}

/// A vector kept as hi + lo, component by component.
struct ExactVector {
  Vec3 hi = Vec3::Zero(), lo = Vec3::Zero();
  Exact operator[](int c) const { return {hi[c], lo[c]}; }
  void set(int c, Exact e) { hi[c] = e.hi, lo[c] = e.lo; }
  bool operator==(const ExactVector&) const = default;
};

/// The vector of three such sums.
[[gnu::always_inline]] inline ExactVector exact_vector(Exact x, Exact y, Exact z) { return {Vec3(x.hi, y.hi, z.hi), Vec3(x.lo, y.lo, z.lo)}; }

[[gnu::always_inline]] inline ExactVector operator-(const ExactVector& a, const ExactVector& b) { return exact_vector(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
[[gnu::always_inline]] inline ExactVector operator+(const ExactVector& a, const ExactVector& b) { return exact_vector(a[0] + b[0], a[1] + b[1], a[2] + b[2]); }

/// s v, exact.
[[gnu::always_inline]] inline ExactVector two_product(double s, const Vec3& v) { return exact_vector(two_product(s, v[0]), two_product(s, v[1]), two_product(s, v[2])); }

/// a · b to about 30 digits of |a||b|.
[[gnu::always_inline]] inline Exact dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Sum of many doubles with about twice the working precision (Neumaier's compensation), in the order given.
class ExactSum {
 public:
  void add(double x) {
    const Exact s = two_sum(total_, x);
    total_ = s.hi, rest_ += s.lo;
  }
  double value() const { return total_ + rest_; }

 private:
  double total_ = 0, rest_ = 0;
};

// What is left when nearly equal lengths are subtracted is still good.

/// √a for a ≥ 0, relative error about 2⁻¹⁰⁰ (one Newton step from the rounded root); 0 for a ≤ 0.
inline Exact square_root(Exact a) {
  if (!(a.hi > 0)) return {};
  const double r = std::sqrt(a.hi);
  return quick_two_sum(r, (a - two_product(r, r)).hi / (2 * r));
}

/// |a|.
inline Exact length(const ExactVector& a) { return square_root(dot(a, a)); }

/// a × b, each component to about 30 digits of |a||b|.
inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return exact_vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

}  // namespace elamin
