#pragma once
#include "laws/radial.hpp"


namespace elamin {

/// How a cohesion ends at its cutoff: cut: as it is, U jumps there; shifted: U − U(cutoff), the force jumps; smooth: the force goes to zero over a
/// shell, with a continuous derivative.  Of one depth and size.
enum class CutoffStyle { cut, shifted, smooth };

/// Cohesion of Lennard-Jones  U = 4ε (s² − s) − shift,  s = (σ/r)⁶,  r = |x₁ − x₀| < cutoff;  U = 0 beyond. As a function of q = r²:
///   ∂U/∂q = −12 ε s (2s − 1)/q,   ∂²U/∂q² = 24 ε s (7s − 2)/q²
/// In the shell inner ≤ r < cutoff of the smooth one, T = cutoff − inner, u = cutoff − r, with F and F' = dF/dr of the above at `inner`:
///   force = u² (a + b u),   U = a u³/3 + b u⁴/4,   a = 3F/T² + F'/T,   b = −2F/T³ − F'/T²
///   ∇₁U = 2 ∂U/∂q d = −∇₀U,   d = x₁ − x₀
///   ∇₁∇₁U = 2 ∂U/∂q I + 4 ∂²U/∂q² d dᵀ = ∇₀∇₀U = −∇₀∇₁U
/// ε [energy] depth of the well, at r = 2^{1/6} σ; σ [length] where U = 0 unless shifted; cutoff [length], 0: no cohesion.
/// Smooth but at the cutoff (the smooth one is C² there) and where the sites meet: U → +inf there, and no derivatives are given.
/// q is formed exactly and s − 1 as a product with σ² − q, so U keeps its digits where it is zero.
/// Source: LAMMPS, pair_style lj/cut, with pair_modify shift yes, and lj/smooth with it.
struct Cohesion {
  static constexpr int sites = 2;
  double epsilon, sigma, cutoff;
  CutoffStyle style = CutoffStyle::cut;
  double inner = 0;                    // smooth: where the shell begins, 0 < inner < cutoff

  /// Of the shell; F [force] is the one at `inner`.
  struct Shell { double force, a, b; };

  double value(const Points<2>& x) const { return value(squared(x.edge(0, 1))); }

  Local<2> derivatives(const Points<2>& x) const { return derivatives(x, 1); }

  /// The same without a part of what is negative of the Hessian's eigenvalues, ∂²U/∂r² along d and ∂U/∂r / r across it.
  Local<2> convex(const Points<2>& x, double part) const { return derivatives(x, 1 - part); }

  /// −2 ∂U/∂q within the cutoff: times d the force on site 1, with ε = depth and σ = size, in the plain
  /// arithmetic of the scalar T.
  template <class T>
  static T push(const T& q, const T& depth, const T& size) {
    const T t = size / q * size, s = t * t * t;
    return T(24.0) * depth * s * (T(2.0) * s - T(1.0)) / q;
  }

  /// The shell's polynomial.
  Shell shell() const {
    const double s = sixth_power(inner * inner), width = cutoff - inner;
    const double force = 24 * epsilon * s * (2 * s - 1) / inner, slope = -24 * epsilon * s * (26 * s - 7) / (inner * inner);
    return {force, (3 * force / width + slope) / width, -(2 * force / width + slope) / (width * width)};
  }

 private:
  // `kept`: the part of negative eigenvalues that stays in the Hessian.
  Local<2> derivatives(const Points<2>& x, double kept) const {
    const ExactVector d = x.edge(0, 1);
    const Exact q2 = squared(d);
    if (!acts(q2)) return {};
    const double q = q2.value(), s = sixth_power(q);
    double first = -12 * epsilon * s * (2 * s - 1) / q, second = 24 * epsilon * s * (7 * s - 2) / q / q;
    if (in_shell(q)) {
      const Shell t = shell();
      const double r = std::sqrt(q), w = to_cutoff(q2), force = w * w * (t.a + t.b * w);
      first = -force / (2 * r), second = (force / r + w * (2 * t.a + 3 * t.b * w)) / (4 * q);
    }
    const double energy = value(q2);
    if (!std::isfinite(energy) || !std::isfinite(second)) return {.value = energy};
    double across = 2 * first, along = 4 * second;                  // along d dᵀ + across I
    if (kept < 1) {
      const auto eased = [kept](double eigenvalue) { return eigenvalue < 0 ? kept * eigenvalue : eigenvalue; };
      along = (eased(along * q + across) - eased(across)) / q, across = eased(across);
    }
    return of_difference(energy, 2 * first * d.hi, d.hi, along, across);
  }

  static Exact squared(const ExactVector& d) { return dot(d, d); }   // q = r²

  bool acts(Exact q) const { return epsilon != 0 && sigma != 0 && (q - two_product(cutoff, cutoff)).hi < 0; }

  bool in_shell(double q) const { return style == CutoffStyle::smooth && q >= inner * inner; }

  // cutoff − r
  double to_cutoff(Exact q) const { return (two_product(cutoff, cutoff) - q).value() / (cutoff + std::sqrt(q.value())); }

  static double energy_in_shell(const Shell& t, double w) { return w * w * w * (t.a / 3 + t.b / 4 * w); }

  // What is taken off the energy inside.
  double shift() const {
    if (style == CutoffStyle::cut) return 0;
    const double end = style == CutoffStyle::smooth ? inner : cutoff, s = sixth_power(end * end), whole = 4 * epsilon * s * (s - 1);
    return style == CutoffStyle::smooth ? whole - energy_in_shell(shell(), cutoff - inner) : whole;
  }

  double sixth_power(double q) const {                               // (σ²/q)³
    const double t = sigma / q * sigma;
    return t * t * t;
  }

  double value(Exact q) const {
    if (!acts(q)) return 0;
    if (!(q.value() > 0)) return infinity;
    if (in_shell(q.value())) return energy_in_shell(shell(), to_cutoff(q));
    const double t = sigma / q.value() * sigma, s = sixth_power(q.value());
    const double excess = (two_product(sigma, sigma) - q).value() / q.value() * (1 + t + t * t);   // t³ − 1 = s − 1
    return 4 * epsilon * s * excess - shift();
  }
};

static_assert(Law<Cohesion>);

}  // namespace elamin
