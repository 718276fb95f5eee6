#pragma once
#include "laws/law.hpp"
#include "laws/section.hpp"
#include "laws/triple.hpp"

#include <algorithm>

namespace elamin {

/// Cosine angle  U = B (1 − cos(θ − θ₀)),  θ the angle at site 1 between sites 0 and 2, θ₀ the angle at rest.
/// With u = x₁ − x₀, w = x₂ − x₁, a = u/|u|, b = w/|w|, the angle φ = π − θ (cos φ = a·b, sin φ = |a × b|, 0 ≤ φ ≤ π) and
/// that at rest φ₀ = π − θ₀:  U = B (1 − cos(φ − φ₀)) = B (1 − cos φ cos φ₀ − sin φ sin φ₀).
/// B [energy], θ₀ [rad].  U = +inf where two sites meet, without derivatives.
///
/// Straight at rest, θ₀ = π:  U = B (1 + cos θ) = B (1 − a·b), smooth.
///   ∂U/∂u = −B b⊥/|u|,   b⊥ = b − (a·b) a = n × a,      n = a × b
///   ∂U/∂w = −B a⊥/|w|,   a⊥ = a − (a·b) b = b × n
///   ∂²U/∂u∂u = B/|u|² [ (a·b)(I − a aᵀ) + a b⊥ᵀ + b⊥ aᵀ ],   ∂²U/∂w∂w the same with a ↔ b, u ↔ w
///   ∂²U/∂u∂w = −B/(|u||w|) (I − a aᵀ)(I − b bᵀ)
/// Near the straight angle n = u × (w − u)/(|u||w|), near the folded one n = u × (w + u)/(|u||w|): the second difference
/// and the closing side are formed exactly, so forces and energies keep their digits for any small angle or opening.
///
/// Any other angle at rest, with S = sin(φ − φ₀), C = cos(φ − φ₀), m = n/|n|, p = m × a, q = b × m:
///   ∂U/∂u = −B S p/|u|,   ∂U/∂w = −B S q/|w|
///   ∂²U/∂u∂u = B/|u|² [ C p pᵀ + S (a pᵀ + p aᵀ) + S cot φ m mᵀ ],   ∂²U/∂w∂w the same with b, q
///   ∂²U/∂u∂w = B/(|u||w|) [ C p qᵀ − S/sin φ m mᵀ ]
/// S is formed as (|u × w| cos φ₀ − u·w sin φ₀)/(|u||w|) with about 30 digits and 1 − C as S²/(1 + C): both keep theirs
/// however near the angle is to rest. The angle has no sign, so U has a conical point where the sites are in line, φ = 0
/// or π: no direction to bend in, no force; the part with sin φ drops out of the derivatives there, they stay finite.
///
/// In a plane, where all sites keep one coordinate, the angle has a sign: sin φ = (a × b)·e with e the unit vector of that
/// coordinate, −π < φ ≤ π, and φ₀ = π − θ₀ is positive. The formulas are the same with m = e, smooth everywhere, so that
/// a curved beam may be bent straight and beyond; the parts with m mᵀ, which lead out of the plane, are left out.
/// ∇₀ = −∂/∂u, ∇₁ = ∂/∂u − ∂/∂w, ∇₂ = ∂/∂w in all cases.
/// Source: Guerra 2021, eq. (9); LAMMPS, angle_style cosine and cosine/shift (its coefficient is Umin = 2B).
struct CosineAngle {
  static constexpr int sites = 3;
  double B;

  /// B [energy], rest = θ₀ [rad], exactly `pi`: straight; kept: the coordinate that the sites keep in a plane, or −1.
  explicit CosineAngle(double stiffness, double rest = pi, int kept = -1)
      : B(stiffness), straight_(rest == pi), kept_(straight_ ? -1 : kept), cos_rest_(std::cos(pi - rest)),
        sin_rest_(std::sin(pi - rest)) {}

  /// b⊥ = b − (a·b) a, of which a straight angle makes ∂U/∂u = −B b⊥/|u| (and of a⊥ ∂U/∂w), in the plain arithmetic of T.
  template <class T>
  static Triple<T> across(const Triple<T>& a, const Triple<T>& b) { return multiply_add(-dot(a, b), a, b); }

  double value(const Points<3>& x) const {
    const Hinge t(x, *this);
    return t.defined ? B * t.versine : infinity;
  }

  Local<3> derivatives(const Points<3>& x) const {
    Local<3> U;
    const Hinge t(x, *this);
    if (!t.defined) {
      U.value = infinity;
      return U;
    }
    U.value = B * t.versine;
    const double Bu = B / t.length_u, Bw = B / t.length_w;
    Vec3 g_u, g_w;
    Mat3 uu, ww, uw;
    if (t.inclined) {
      const Vec3 m = kept_ >= 0 ? Vec3(Vec3::Unit(kept_)) : Vec3(t.n / t.sine), p = m.cross(t.a), q = t.b.cross(m);
      g_u = -Bu * t.S * p, g_w = -Bw * t.S * q;
      const Mat3 pp = p * p.transpose(), qq = q * q.transpose(), pq = p * q.transpose(), mm = m * m.transpose();
      const Mat3 ap = t.a * p.transpose(), bq = t.b * q.transpose();
      const double across = kept_ >= 0 ? 0 : t.S / t.sine;
      uu = Bu / t.length_u * (t.C * pp + t.S * (ap + ap.transpose()) + across * t.cosine * mm);
      ww = Bw / t.length_w * (t.C * qq + t.S * (bq + bq.transpose()) + across * t.cosine * mm);
      uw = Bu / t.length_w * (t.C * pq - across * mm);
    } else {
      const Vec3 a_perp = t.b.cross(t.n), b_perp = t.n.cross(t.a);
      g_u = -Bu * b_perp, g_w = -Bw * a_perp;
      const Mat3 A = Mat3::Identity() - t.a * t.a.transpose(), C = Mat3::Identity() - t.b * t.b.transpose();
      const Mat3 ab = t.a * b_perp.transpose(), ba = t.b * a_perp.transpose();
      uu = B / (t.length_u * t.length_u) * (t.cosine * A + (ab + ab.transpose()));
      ww = B / (t.length_w * t.length_w) * (t.cosine * C + (ba + ba.transpose()));
      uw = -B / (t.length_u * t.length_w) * (A * C);
      if (!straight_) {                                  // in line: n = 0, and of U only −B cos φ cos φ₀ is smooth
        g_u.setZero(), g_w.setZero();
        uu *= cos_rest_, ww *= cos_rest_, uw *= cos_rest_;
      }
    }
    U.force_part(0) = -g_u;
    U.force_part(1) = g_u - g_w;
    U.force_part(2) = g_w;
    U.block(0, 0) = uu;
    U.block(0, 1) = uw - uu;
    U.block(0, 2) = -uw;
    U.block(1, 1) = uu + ww - (uw + uw.transpose());
    U.block(1, 2) = uw - ww;
    U.block(2, 2) = ww;
    U.block(1, 0) = U.block(0, 1).transpose();
    U.block(2, 0) = U.block(0, 2).transpose();
    U.block(2, 1) = U.block(1, 2).transpose();
    return U;
  }

  /// The same with the Hessian of Gauss and Newton for a part of its own. That is positive semidefinite: straight at rest U = B/2 |a − b|² gives B Jᵀ J, J the derivative of
  /// a − b; any other U = B (1 − cos ψ), ψ = φ − φ₀, gives B max(cos ψ, 0) ∇ψ ∇ψᵀ.
  Local<3> convex(const Points<3>& x, double part) const {
    Local<3> U = derivatives(x);
    const Hinge t(x, *this);
    if (!t.defined) return U;
    Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();     // of a − b or, in its first row, of ψ; times √B
    if (t.inclined) {
      const Vec3 m = kept_ >= 0 ? Vec3(Vec3::Unit(kept_)) : Vec3(t.n / t.sine);
      J.row(0).head<3>() = m.cross(t.a) / t.length_u, J.row(0).tail<3>() = -t.b.cross(m) / t.length_w;
      J.row(0).segment<3>(3) = -J.row(0).head<3>() - J.row(0).tail<3>();
      J *= std::sqrt(B * std::max(t.C, 0.0));
    } else {
      J.leftCols<3>() = (t.a * t.a.transpose() - Mat3::Identity()) / t.length_u;
      J.rightCols<3>() = (t.b * t.b.transpose() - Mat3::Identity()) / t.length_w;
      J.middleCols<3>(3) = -J.leftCols<3>() - J.rightCols<3>();
      J *= std::sqrt(B * std::abs(cos_rest_));
    }
    U.hessian *= 1 - part;
    U.hessian.noalias() += part * J.transpose() * J;
    return U;
  }

  /// How the sites bend: the angle φ [rad], in a plane with its sign; the curvature φ/ℓ, ℓ = (|u| + |w|)/2 [1/length]; the moment
  /// M = ∂U/∂φ = B sin(φ − φ₀) [force·length]; m, the unit vector about which φ grows. 0 where two sites meet, and, not straight at rest,
  /// where all are in line: no direction to bend in.
  struct Bending {
    double angle = 0, curvature = 0, moment = 0;
    Vec3 axis = Vec3::Zero();
  };
  Bending bending(const Points<3>& x) const {
    const Hinge t(x, *this);
    Bending b;
    if (!t.defined) return b;
    const double sine = straight_ ? t.n.norm() : t.sine;
    b.angle = std::atan2(sine, t.cosine), b.curvature = 2 * b.angle / (t.length_u + t.length_w);
    if (kept_ >= 0) b.axis = Vec3::Unit(kept_);
    else if (sine > 0) b.axis = t.n / sine;
    if (straight_ || t.inclined) b.moment = B * (straight_ ? sine : t.S);
    return b;
  }

  /// ∂(∇U)/∂λ where B changes with a parameter λ: as ∇U, with ∂B/∂λ instead of B.
  Eigen::Matrix<double, 9, 1> gradient_rate(const Points<3>& x, const CosineAngle& rate) const {
    return rate.derivatives(x).gradient;
  }

 private:
  bool straight_;
  int kept_;
  double cos_rest_, sin_rest_;                           // of φ₀

  struct Hinge {
    bool defined = false;
    bool inclined = false;                               // not straight at rest; the sites not in line, or in a plane
    double length_u = 0, length_w = 0, cosine = 0;       // cosine = a·b = cos φ = −cos θ
    double sine = 0, S = 0, C = 0;                       // sin φ, sin(φ − φ₀), cos(φ − φ₀); where inclined
    double versine = 0;                                  // 1 − cos(φ − φ₀)
    Vec3 a, b, n;                                        // n = a × b, |n| = sin φ

    Hinge(const Points<3>& x, const CosineAngle& law) {
      const ExactVector u = x.edge(0, 1), w = x.edge(1, 2);
      length_u = u.hi.norm(), length_w = w.hi.norm();
      if (!(length_u > 0 && length_w > 0)) return;
      defined = true;
      a = u.hi / length_u, b = w.hi / length_w;
      cosine = a.dot(b);
      law.straight_ ? from_straight(u, w) : from_rest(u, w, law);
    }

    /// 1 − cos φ = sin²φ/(1 + cos φ), without cancellation.
    void from_straight(const ExactVector& u, const ExactVector& w) {
      const ExactVector small = cosine > 0 ? w - u : w + u;
      n = a.cross((small.hi + small.lo) / length_w);
      versine = cosine > 0 ? n.squaredNorm() / (1 + cosine) : 1 - cosine;
    }

    void from_rest(const ExactVector& u, const ExactVector& w, const CosineAngle& law) {
      const ExactVector normal = cross(u, w);
      const Exact across = law.kept_ >= 0 ? normal[law.kept_] : length(normal), along = dot(u, w);
      const double product = length_u * length_w;
      n = normal.hi / product, sine = across.value() / product;
      inclined = law.kept_ >= 0 || sine > 0;
      S = (across * Exact{law.cos_rest_} - along * Exact{law.sin_rest_}).value() / product;
      C = cosine * law.cos_rest_ + sine * law.sin_rest_;
      versine = C > 0 ? S * S / (1 + C) : 1 - C;
    }
  };
};

static_assert(Law<CosineAngle>);

}  // namespace elamin
