#pragma once
// Four doubles at a time.
#include "laws/triple.hpp"

#include <cmath>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

#pragma GCC diagnostic ignored "-Wpsabi"   // everything here is inlined

namespace elamin {

/// A scalar for the laws that stands for four doubles; every operation acts on each of them.
struct Lanes {
  static constexpr int count = 4;
  typedef double Four __attribute__((vector_size(32)));
  Four v;

  Lanes() = default;
  Lanes(Four four) : v(four) {}
  Lanes(double all) : v{all, all, all, all} {}
  Lanes(double a, double b, double c, double d) : v{a, b, c, d} {}
  static Lanes load(const double* p) {
    Lanes a;
    std::memcpy(&a.v, p, sizeof a.v);
    return a;
  }
  void store(double* p) const { std::memcpy(p, &v, sizeof v); }
  /// p[i₀], …, p[i₃].
  static Lanes gather(const double* p, const int* i) { return {p[i[0]], p[i[1]], p[i[2]], p[i[3]]}; }
  double operator[](int k) const { return v[k]; }
  double sum() const { return (v[0] + v[1]) + (v[2] + v[3]); }
  double largest() const { return std::fmax(std::fmax(v[0], v[1]), std::fmax(v[2], v[3])); }

  Lanes& operator+=(Lanes b) { return v += b.v, *this; }
  Lanes& operator-=(Lanes b) { return v -= b.v, *this; }
  friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend Lanes operator-(Lanes a) { return -a.v; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
#ifdef __FMA__
    return Four(_mm256_fmadd_pd(a.v, b.v, c.v));
#else
    return a.v * b.v + c.v;
#endif
  }
  friend Lanes max(Lanes a, Lanes b) { return a.v > b.v ? a.v : b.v; }
  friend Lanes min(Lanes a, Lanes b) { return a.v < b.v ? a.v : b.v; }
  friend Lanes abs(Lanes a) { return max(a, -a); }
  friend Lanes sqrt(Lanes a) {
#ifdef __AVX__
    return Four(_mm256_sqrt_pd(a.v));
#else
    return {std::sqrt(a.v[0]), std::sqrt(a.v[1]), std::sqrt(a.v[2]), std::sqrt(a.v[3])};
#endif
  }
  /// b where a is positive, else 0.
  friend Lanes where(Lanes a, Lanes b) { return a.v > 0 ? b.v : a.v - a.v; }
  /// 1/a, and 0 where a is 0.
  friend Lanes inverse(Lanes a) { return a.v > 0 ? 1 / a.v : a.v - a.v; }
  /// Bit k: a_k < b_k.
  friend unsigned below(Lanes a, Lanes b) {
#ifdef __AVX__
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)));
#else
    unsigned bits = 0;
    for (int k = 0; k < count; ++k) bits |= unsigned(a.v[k] < b.v[k]) << k;
    return bits;
#endif
  }
};

/// Columns to rows: (x₀ y₀ z₀ ·), (x₁ y₁ z₁ ·), … from x, y, z and a fourth of four things, and back.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes::Four ab_low = __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6), ab_high = __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7);
  const Lanes::Four cd_low = __builtin_shufflevector(c.v, d.v, 0, 4, 2, 6), cd_high = __builtin_shufflevector(c.v, d.v, 1, 5, 3, 7);
  a.v = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b.v = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  c.v = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  d.v = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// x, y, z of four rows.
inline Triple<Lanes> columns_of(Lanes a, Lanes b, Lanes c, Lanes d) {
  transpose(a, b, c, d);
  return {a, b, c};
}

}  // namespace elamin
