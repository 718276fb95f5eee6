#pragma once
#include "laws/law.hpp"

#include <limits>

namespace elamin {

/// Cohesion of Lennard-Jones  U = 4ε (s² − s),  s = (σ/r)⁶,  r = |x₁ − x₀| < cutoff;  U = 0 beyond, with a jump at the
/// cutoff (not shifted).  As a function of q = r²:
///   ∂U/∂q = −12 ε s (2s − 1)/q,   ∂²U/∂q² = 24 ε s (7s − 2)/q²
///   ∇₁U = 2 ∂U/∂q d = −∇₀U,   d = x₁ − x₀
///   ∇₁∇₁U = 2 ∂U/∂q I + 4 ∂²U/∂q² d dᵀ = ∇₀∇₀U = −∇₀∇₁U
/// ε [energy] depth of the well, at r = 2^{1/6} σ; σ [length] where U = 0; cutoff [length], 0: no cohesion.
/// Smooth but at the cutoff and where the sites meet: U → +inf there, and no derivatives are given.
/// q is formed exactly and s − 1 as a product with σ² − q, so U keeps its digits where it is zero.
/// Source: LAMMPS, pair_style lj/cut.
struct Cohesion {
  static constexpr int sites = 2;
  double epsilon, sigma, cutoff;

  double value(const Points<2>& x) const { return value(squared(x.edge(0, 1))); }

  Local<2> derivatives(const Points<2>& x) const {
    Local<2> u;
    const ExactVector d = x.edge(0, 1);
    const Exact q2 = squared(d);
    if (!acts(q2)) return u;
    u.value = value(q2);
    const double q = q2.value(), s = sixth_power(q);
    const double first = -12 * epsilon * s * (2 * s - 1) / q, second = 24 * epsilon * s * (7 * s - 2) / q / q;
    if (!std::isfinite(u.value) || !std::isfinite(second)) return u;
    u.force_part(1) = 2 * first * d.hi;
    u.force_part(0) = -u.force_part(1);
    Mat3 h = d.hi * d.hi.transpose();
    h *= 4 * second;
    h.diagonal().array() += 2 * first;
    u.block(0, 0) = u.block(1, 1) = h;
    u.block(0, 1) = u.block(1, 0) = -h;
    return u;
  }

  /// −2 ∂U/∂q within the cutoff: times d the force on site 1, with ε = depth and σ = size, in the plain
  /// arithmetic of the scalar T.
  template <class T>
  static T push(const T& q, const T& depth, const T& size) {
    const T t = size / q * size, s = t * t * t;
    return T(24.0) * depth * s * (T(2.0) * s - T(1.0)) / q;
  }

 private:
  static Exact squared(const ExactVector& d) { return dot(d, d); }   // q = r²

  bool acts(Exact q) const { return epsilon != 0 && sigma != 0 && (q - two_product(cutoff, cutoff)).hi < 0; }

  double sixth_power(double q) const {                               // (σ²/q)³
    const double t = sigma / q * sigma;
    return t * t * t;
  }

  double value(Exact q) const {
    if (!acts(q)) return 0;
    if (!(q.value() > 0)) return std::numeric_limits<double>::infinity();
    const double t = sigma / q.value() * sigma, s = sixth_power(q.value());
    const double excess = (two_product(sigma, sigma) - q).value() / q.value() * (1 + t + t * t);   // t³ − 1 = s − 1
    return 4 * epsilon * s * excess;
  }
};

static_assert(Law<Cohesion>);

}  // namespace elamin
