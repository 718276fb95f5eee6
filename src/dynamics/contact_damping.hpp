#pragma once
// What a contact does beside its elastic force: damping along its normal, friction across it.
#include "laws/triple.hpp"
#include "model/model.hpp"

#include <cmath>
#include <limits>

namespace elamin {

/// The coefficient γ of tsuji's damping for a coefficient of restitution e in [0, 1]:
///   1.2728 − 4.2783 e + 11.087 e² − 22.348 e³ + 27.467 e⁴ − 18.022 e⁵ + 4.8218 e⁶
/// (3·10⁻⁴ at e = 1). A Hertz contact that is damped so gives back exp(−π γ/√(5 − γ²)) of the speed, which is more than e:
/// 0.44 for 0.3, 0.70 for 0.6, 0.93 for 0.9; LAMMPS's collisions do the same. Source: Tsuji, Tanaka, Ishida 1992, as fitted by LAMMPS, pair_style granular.
double tsuji_coefficient(double restitution);

/// How one contact damps, δ its overlap, F its elastic force, n its normal, v the velocity of site 1 against site 0:
///   normal      N = F − η v·n
///               velocity  η = γ     mass_velocity  γ m     viscoelastic  γ m √(R δ)     tsuji  γ √(m k √δ)
///   tangential  T = −min(μ |N|, x η |w|) w/|w|,   w = v − (v·n) n + n × (r₀ ω₀ + r₁ ω₁)
/// with k of Hertz's force k δ^{3/2}, the effective radius R and mass m = m₀ m₁/(m₀ + m₁); at a wall m is the particle's.
/// (LAMMPS: k √δ is the force divided by the overlap, not its slope.)  Any scalar T.
struct DampedContact {
  double coefficient = 0;                                // c of η = c, c √δ or c √√δ …
  int roots = 0;                                         // … and how many roots are taken
  double tangential = 0, friction = 0;                   // x, μ

  DampedContact() = default;
  DampedContact(const ContactDamping& damping, double mass, double stiffness, double effective_radius);
  bool rubs() const { return tangential > 0 && friction > 0; }
};

/// η = c, c √δ, c √√δ for 0, 1, 2 roots.
template <class T>
T damping_coefficient(const T& overlap, const T& c, int roots) {
  using std::sqrt;
  if (roots == 0) return c;
  const T a = sqrt(overlap);
  return c * (roots == 1 ? a : sqrt(a));
}

/// The friction on site 1; `turning` = r₀ ω₀ + r₁ ω₁, `along` = v·n, `normal` = N. The torque on either site is
/// −(r − δ/2) n × T, at a wall with r.
template <class T>
Triple<T> friction(const Triple<T>& n, const Triple<T>& v, const T& along, const Triple<T>& turning, const T& normal,
                   const T& tangential_damping, const T& coefficient) {
  using std::abs, std::max, std::min, std::sqrt;
  const Triple<T> w = v - along * n + cross(n, turning);
  const T speed = max(sqrt(dot(w, w)), T(std::numeric_limits<double>::min()));
  return -min(coefficient * abs(normal) / speed, tangential_damping) * w;
}

}  // namespace elamin
