#pragma once
#include "laws/radial.hpp"

namespace elamin {

/// Hertz contact of two spheres  U = 8/15 E √R δ^{5/2} = 2/5 k δ^{5/2},  δ = ρ − r > 0,  r = |x₁ − x₀|;  U = 0 for δ ≤ 0.
///   ρ = r₀ + r₁,  R = r₀r₁/ρ,  k = 4/3 E √R,  E the effective modulus: 1/E = (1 − ν₀²)/E₀ + (1 − ν₁²)/E₁
///   ∇₁U = −k δ^{3/2} n = −∇₀U,   n = (x₁ − x₀)/r
///   ∇₁∇₁U = 3/2 k δ^{1/2} n nᵀ − k δ^{3/2}/r (I − n nᵀ) = ∇₀∇₀U = −∇₀∇₁U
/// k [force/length^{3/2}], ρ [length].  C² only: the third derivative is infinite at first touch, δ = 0.
/// Where the centres meet, r = 0, there is no direction: U is finite, no force; the Hessian is taken as 3/2 k δ^{1/2} I.
/// The overlap is formed as (ρ² − r²)/(ρ + r) with ρ² − r² exact, so an overlap of 1e-12 ρ keeps all its digits.
/// Source: Guerra 2021, eq. (4) and the effective modulus below eq. (5); Johnson 1985, Contact Mechanics, chapter 4.
struct HertzContact {
  static constexpr int sites = 2;
  double stiffness;                            // k = 4/3 E √R [force/length^{3/2}]
  double contact_distance;                                // ρ [length]

  double value(const Points<2>& x) const {
    const ExactVector d = x.edge(0, 1);
    return clear(d) ? 0.0 : energy(-gap(d));
  }

  Local<2> derivatives(const Points<2>& x) const { return derivatives(x, 1); }

  /// The same without a part of −k δ^{3/2}/r (I − n nᵀ) in the Hessian, which is positive semidefinite without all of it.
  Local<2> convex(const Points<2>& x, double part) const { return derivatives(x, 1 - part); }

  /// k δ^{3/2} of the overlap δ ≥ 0, the force along n, in the plain arithmetic of the scalar T.
  template <class T>
  static T push(const T& overlap, const T& stiffness) {
    using std::sqrt;
    return stiffness * overlap * sqrt(overlap);
  }

  /// r − ρ, the distance of the surfaces, exact differences; negative: overlap. [length]
  double gap(const Points<2>& x) const { return gap(x.edge(0, 1)); }

  /// Force between the spheres at that gap, k (−gap)^{3/2}; 0 where they do not overlap.
  double force(double gap) const { return gap < 0 ? stiffness * -gap * std::sqrt(-gap) : 0.0; }

 private:
  Local<2> derivatives(const Points<2>& x, double turning) const {
    const ExactVector d = x.edge(0, 1);
    if (clear(d)) return {};
    const double overlap = -gap(d);
    if (!(overlap > 0)) return {};
    const double f = force(-overlap);                                // k δ^{3/2}
    return radial(d.hi, energy(overlap), -f, 1.5 * stiffness * std::sqrt(overlap), -turning * f / d.hi.norm());
  }

  /// Farther apart than rounding could hide: most candidates are.
  bool clear(const ExactVector& d) const { return d.hi.squaredNorm() > (1 + 64 * epsilon) * contact_distance * contact_distance; }

  double gap(const ExactVector& d) const {
    const Exact excess = dot(d, d) - two_product(contact_distance, contact_distance);      // r² − ρ²
    const double sum = d.hi.norm() + contact_distance;
    return sum > 0 ? excess.value() / sum : 0.0;
  }

  double energy(double overlap) const { return overlap > 0 ? 0.4 * force(-overlap) * overlap : 0.0; }
};

static_assert(Law<HertzContact>);

/// k = 4/3 E √(r₀r₁/(r₀ + r₁)) [force/length^{3/2}] from the effective modulus E [force/length²] and the radii [length].
inline double hertz_stiffness(double effective_modulus, double r0, double r1) {
  return effective_modulus * 4 / 3 * std::sqrt(r0 * (r1 / (r0 + r1)));
}

}  // namespace elamin
