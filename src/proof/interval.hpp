#pragma once
// Intervals that contain what exact arithmetic gives, whatever rounding does.
#include "core/types.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

/// A floating-point number of 113 bits (IEEE binary128), in software.
using Quad = __float128;

/// Bounds of one rounding to nearest, z → x: |z − x| ≤ u |x| + η, u half the spacing at 1, η of underflow, where tiny results may count as
/// zero. Widening by 4u |x| and a number above η covers it together with the roundings of the widening itself.
template <class T> struct Rounding;
template <> struct Rounding<double> { static constexpr double widening = 0x1p-51, least = 0x1p-1021; };
template <> struct Rounding<Quad> {
  static constexpr Quad small = 0x1p-1000, widening = 0x1p-111, least = small * small * small * small * small * small * small * small;
};

/// [lo, hi], both included. Results contain the exact ones for all numbers in the operands; where there is no bound, as of a quotient by
/// an interval with 0 in it or after an overflow, the result is (−∞, ∞). Nothing is assumed but rounding to nearest, so that the rounding
/// mode is left alone; a fused multiply-add rounds once instead of twice, and is covered. T: double or Quad.
/// Source: Moore, Kearfott, Cloud 2009, Introduction to Interval Analysis, chapters 2 and 3.
template <class T>
struct Interval {
  T lo = 0, hi = 0;

  Interval() = default;
  Interval(T x) : lo(x), hi(x) {}
  Interval(T from, T to) : lo(from), hi(to) {}
  /// To fewer digits or more.
  template <class S> requires(!std::same_as<S, T>)
  explicit Interval(const Interval<S>& x) { *this = outward(static_cast<T>(x.lo), static_cast<T>(x.hi)); }

  /// The largest size of a number in it, and whether all are bounded.
  T mag() const { return std::max(lo < 0 ? -lo : lo, hi < 0 ? -hi : hi); }
  T middle() const { return lo + (hi - lo) / 2; }
  bool bounded() const { return lo - lo == 0 && hi - hi == 0; }

  static Interval all() { return {-T(HUGE_VAL), T(HUGE_VAL)}; }
  static Interval outward(T from, T to) {
    const auto more = [](T x) { return (x < 0 ? -x : x) * Rounding<T>::widening + Rounding<T>::least; };
    const Interval r{from - more(from), to + more(to)};
    return r.bounded() ? r : all();
  }

  friend Interval operator+(const Interval& a, const Interval& b) { return outward(a.lo + b.lo, a.hi + b.hi); }
  friend Interval operator-(const Interval& a, const Interval& b) { return outward(a.lo - b.hi, a.hi - b.lo); }
  friend Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }
  friend Interval operator*(const Interval& a, const Interval& b) {
    if (!a.bounded() || !b.bounded()) return all();
    const T p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
  }
  friend Interval operator/(const Interval& a, const Interval& b) {
    if (!a.bounded() || !b.bounded() || !(b.lo > 0 || b.hi < 0)) return all();
    const T p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
  }
  Interval& operator+=(const Interval& b) { return *this = *this + b; }
  Interval& operator-=(const Interval& b) { return *this = *this - b; }
  Interval& operator*=(const Interval& b) { return *this = *this * b; }
  Interval& operator/=(const Interval& b) { return *this = *this / b; }
  friend bool operator==(const Interval& a, const Interval& b) { return a.lo == b.lo && a.hi == b.hi; }

  /// x² of all x in it.
  friend Interval square(const Interval& a) {
    const Interval p = a * a;
    return {std::max(p.lo, T(0)), p.hi};
  }
  /// max(x, 0).
  friend Interval positive(const Interval& a) { return {std::max(a.lo, T(0)), std::max(a.hi, T(0))}; }
  /// √x of what is not negative in it. A bound is a root s in double precision after two steps of Heron's, widened, and is taken only if
  /// s² is on its side of x, else 0 or ∞; none above is less than 2⁻⁵⁰⁰, where a root in doubles may be 0.
  friend Interval sqrt(const Interval& a) {
    if (!a.bounded() || a.hi < 0) return all();
    const auto widened = [](T x) {
      T s = T(std::sqrt(static_cast<double>(x)));
      for (int k = 0; k < 2 && s > 0; ++k) s = (s + x / s) / T(2);
      return outward(s, s);
    };
    const T low = a.lo > 0 ? widened(a.lo).lo : T(0), high = a.hi > 0 ? std::max(widened(a.hi).hi, T(0x1p-500)) : T(0);
    const bool below = low > 0 && (Interval(low) * Interval(low)).hi <= a.lo, above = (Interval(high) * Interval(high)).lo >= a.hi;
    return {below ? low : T(0), above || a.hi == 0 ? high : T(HUGE_VAL)};
  }
};

template <class I> using Vector3 = Eigen::Matrix<I, 3, 1>;
template <class I> using Matrix3 = Eigen::Matrix<I, 3, 3>;

/// |d| [as d].
template <class I> I length(const Vector3<I>& d) { return sqrt(square(d[0]) + square(d[1]) + square(d[2])); }

}  // namespace elamin
