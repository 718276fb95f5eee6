#pragma once
#include "laws/radial.hpp"

namespace elamin {

/// Harmonic bond  U = K (r − r₀)²,  r = |x₁ − x₀|.
///   ∇₁U = 2K (r − r₀) n = −∇₀U,   n = (x₁ − x₀)/r
///   ∇₁∇₁U = 2K [ n nᵀ + (1 − r₀/r)(I − n nᵀ) ] = ∇₀∇₀U = −∇₀∇₁U
/// Where K and r₀ change with a parameter λ:  ∂(∇₁U)/∂λ = 2 (K' (r − r₀) − K r₀') n.
/// K [energy/length²] (no factor ½, as in LAMMPS), r₀ [length].  Smooth but for r = 0, where U = K r₀² and, as in LAMMPS,
/// there is no force; the Hessian is taken as that of r₀ = 0 there.
/// The stretch is formed as (r² − r₀²)/(r + r₀) with r² − r₀² exact, so a strain of 1e-12 keeps all its digits.
/// Source: Guerra 2021, eq. (6).
struct HarmonicBond {
  static constexpr int sites = 2;
  double K, r0, r0_tail = 0;                    // r₀ = r0 + r0_tail where r0 alone would round a small change of it away

  double value(const Points<2>& x) const {
    const double e = stretch(x.edge(0, 1));
    return K * e * e;
  }

  /// N = ∂U/∂r = 2K (r − r₀), the tension [force], and (r − r₀)/r₀, the strain.
  double tension(const Points<2>& x) const { return pull(stretch(x.edge(0, 1)), K, 0.0); }
  double strain(const Points<2>& x) const { return stretch(x.edge(0, 1)) / r0; }

  /// ∂U/∂r = 2K (r − r₀), the pull along the bond, in the plain arithmetic of the scalar T.
  template <class T>
  static T pull(const T& r, const T& K, const T& r0) { return T(2.0) * K * (r - r0); }

  Local<2> derivatives(const Points<2>& x) const {
    const ExactVector d = x.edge(0, 1);
    return derivatives(d, stretch(d));
  }

  /// The same, but with the transverse stiffness of the force that the linearisation at `from` predicts,
  ///   2K [ n nᵀ + (ê/r)(I − n nᵀ) ],   ê = (r̄ − r₀) + n̄·(d − d̄),   barred: at `from`,
  /// instead of that of the stretch that a straight step of finite length makes: Newton's method on the mixed energy
  /// U(x, N) = N (r − r₀) − N²/4K with N eliminated. Source: Magisano, Leonetti, Garcea 2017 (mixed integration points).
  Local<2> derivatives(const Points<2>& x, const Points<2>& from) const {
    return derivatives(x.edge(0, 1), linearised(x, from));
  }

  /// The same without a part of the transverse stiffness where the predicted force presses, ê < 0; without all of it the Hessian is positive semidefinite.
  Local<2> convex(const Points<2>& x, const Points<2>& from, double part) const {
    const double e = linearised(x, from);
    return derivatives(x.edge(0, 1), e < 0 ? (1 - part) * e : e);
  }

  /// K (e − ê)²: energy of the part of the stretch e = r − r₀ that the linearisation at `from` did not predict.
  double residual_energy(const Points<2>& x, const Points<2>& from) const {
    const double e = stretch(x.edge(0, 1)) - linearised(x, from);
    return K * e * e;
  }

  /// uᵀHv = 2K [ (1 − t)(n·w)(n·z) + t w·z ],  w = u₁ − u₀,  z = v₁ − v₀,  t = 1 − r₀/r: of a motion across the bond the factor t keeps its digits,
  /// which are lost where 2K n nᵀ is rounded entry by entry.
  BilinearForm form(const Points<2>& x, const Eigen::Matrix<double, 3, 2>& u, const Eigen::Matrix<double, 3, 2>& v) const {
    const ExactVector d = x.edge(0, 1);
    const double r = d.hi.norm(), t = r > 0 ? stretch(d) / r : 1.0;
    const Vec3 n = r > 0 ? Vec3(d.hi / r) : Vec3(Vec3::Zero()), w = u.col(1) - u.col(0), z = v.col(1) - v.col(0);
    const double along = n.dot(w), also = n.dot(z);
    const double most = n.cwiseAbs().dot(w.cwiseAbs()), also_most = n.cwiseAbs().dot(z.cwiseAbs());       // what n·w and n·z are summed from
    return {2 * K * ((1 - t) * along * also + t * w.dot(z)),
            2 * K * (std::abs(1 - t) * (most * std::abs(also) + std::abs(along) * also_most + epsilon * most * also_most) +
                     std::abs(t) * w.cwiseAbs().dot(z.cwiseAbs()))};
  }

  /// ∂(∇U)/∂λ for given ∂K/∂λ and ∂r₀/∂λ.
  Eigen::Matrix<double, 6, 1> gradient_rate(const Points<2>& x, const HarmonicBond& rate) const {
    const ExactVector d = x.edge(0, 1);
    const double r = d.hi.norm();
    Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
    if (r > 0) g.tail<3>() = 2 * (rate.K * stretch(d) - K * rate.r0) / r * d.hi;
    g.head<3>() = -g.tail<3>();
    return g;
  }

 private:
  Local<2> derivatives(const ExactVector& d, double transverse_stretch) const {
    const double e = stretch(d);
    return radial(d.hi, K * e * e, 2 * K * e, 2 * K, 2 * K * transverse_stretch / d.hi.norm());      // 2K (1 − r₀/r)
  }

  double linearised(const Points<2>& x, const Points<2>& from) const {
    const ExactVector d = from.edge(0, 1);
    const double r = d.hi.norm();
    return stretch(d) + (r > 0 ? d.hi.dot((x.edge(0, 1) - d).hi) / r : 0.0);
  }

  double stretch(const ExactVector& d) const {                       // r − r₀
    const double r = d.hi.norm();
    const Exact excess = dot(d, d) - two_product(r0, r0);            // r² − r₀²
    return r + r0 > 0 ? (excess.hi + (excess.lo - 2 * r0 * r0_tail)) / (r + r0) : 0.0;
  }
};

static_assert(Law<HarmonicBond>);

}  // namespace elamin
