#pragma once
// Rotation vectors: where a rotation leads to, and how that varies.
#include "laws/rounded/carried.hpp"
#include "laws/rounded/pose.hpp"

#include <cmath>

namespace elamin {

/// The rotation vector φ of a unit quaternion, exp([φ]×) = R, 0 ≤ |φ| ≤ 2π: q and −q, one rotation, have two vectors, so
/// that φ is continuous along a motion through |φ| = π.
inline Vec3 rotation_vector(const Eigen::Quaterniond& q) {
  const double s = q.vec().norm();
  return s > 0 ? Vec3(2 * std::atan2(s, q.w()) / s * q.vec()) : Vec3(Vec3::Zero());
}

/// The same of the rotation that leads from q to p, the shorter way.
inline Vec3 rotation_between(const Eigen::Quaterniond& q, const Eigen::Quaterniond& p) {
  Eigen::Quaterniond d = p * q.conjugate();
  if (d.w() < 0) d.coeffs() = -d.coeffs();
  return rotation_vector(d);
}

/// How exp([θ + δ]×) = exp([ω]×) exp([θ]×) turns with δ:  ω = J δ + Q(δ, δ)/2 + O(δ³),
///   J = I + a [θ]× + b [θ]×²,   a = (1 − cos φ)/φ²,   b = (φ − sin φ)/φ³,   φ = |θ|;   Q(δ, δ) = (∂J/∂θ · δ) δ
/// J: left Jacobian of SO(3) (Chirikjian 2012, Stochastic Models 2, sec. 10.5).
class RotationChart {
 public:
  explicit RotationChart(const Vec3& theta) : theta_(theta) {
    const double p2 = theta.squaredNorm(), p = std::sqrt(p2);
    if (p < 0.03) {                                              // series: the next terms are below 1e-17 of these
      a_ = 0.5 - p2 / 24 + p2 * p2 / 720 - p2 * p2 * p2 / 40320, b_ = 1.0 / 6 - p2 / 120 + p2 * p2 / 5040;
      da_ = -1.0 / 12 + p2 / 180 - p2 * p2 / 6720, db_ = -1.0 / 60 + p2 / 1260 - p2 * p2 / 60480;
    } else {
      const double s = std::sin(p / 2), versine = 2 * s * s, rest = p - std::sin(p);
      a_ = versine / p2, b_ = rest / (p2 * p);
      da_ = (std::sin(p) / p2 - 2 * versine / (p2 * p)) / p, db_ = (versine / (p2 * p) - 3 * rest / (p2 * p2)) / p;
    }
  }

  Mat3 jacobian() const {
    const Mat3 t = cross_matrix(theta_);
    return Mat3::Identity() + a_ * t + b_ * t * t;
  }
  /// The symmetric matrix M with δᵀ M δ = g · Q(δ, δ).
  Mat3 curvature(const Vec3& g) const {
    const Vec3 t = da_ * g.cross(theta_) + db_ * (g.dot(theta_) * theta_ - theta_.squaredNorm() * g) - b_ * g;
    const Mat3 m = theta_ * t.transpose();
    return (m + m.transpose()) / 2 + b_ * g.dot(theta_) * Mat3::Identity();
  }

 private:
  Vec3 theta_;
  double a_, b_, da_, db_;                                       // da_, db_: a′/φ, b′/φ
};

/// A torque τ that turns a body from its rotation R₀: U = −τ·φ, φ the rotation vector of R R₀ᵀ; with a fixed axis, or
/// for small φ, a constant torque τ. By θ, R → exp([θ]×) R:
///   gradient −J⁻ᵀ τ,   J⁻ᵀ = I + ½ [φ]× + c [φ]×²,   c = (1 − (φ/2) cot(φ/2))/φ²
///   Hessian  the symmetric part of ∂(−J⁻ᵀ τ)/∂φ J⁻¹
struct RotationTorque {
  Vec3 torque = Vec3::Zero();                                    // τ [force·length]
  Eigen::Quaterniond from = Eigen::Quaterniond::Identity();      // R₀

  Vec3 turned(const Eigen::Quaterniond& rotation) const { return rotation_vector(rotation * from.conjugate()); }
  double value(const Eigen::Quaterniond& rotation) const { return -torque.dot(turned(rotation)); }

  Local<1> derivatives(const Eigen::Quaterniond& rotation) const {
    Local<1> u;
    const Vec3 f = turned(rotation);
    const double p2 = f.squaredNorm(), p = std::sqrt(p2);
    double c = 1.0 / 12 + p2 / 720 + p2 * p2 / 30240, dc = 1.0 / 360 + p2 / 7560 + p2 * p2 / 201600;   // dc: c′/φ
    if (p > 0.05) {
      const double sine = std::sin(p / 2), cot = std::cos(p / 2) / sine;
      c = (1 - p / 2 * cot) / p2, dc = ((p / (4 * sine * sine) - cot / 2) / p2 - 2 * c / p) / p;
    }
    const Mat3 F = cross_matrix(f), T = cross_matrix(torque);
    const Vec3 ft = f.cross(torque);
    u.value = -torque.dot(f);
    u.gradient = -(torque + ft / 2 + c * f.cross(ft));
    // ∂(J⁻ᵀτ)/∂φ · δ = ½ δ×τ + c (δ×(φ×τ) + φ×(δ×τ)) + (c′/φ)(φ·δ) φ×(φ×τ)
    const Mat3 slope = -T / 2 - c * (cross_matrix(ft) + F * T) + dc * f.cross(ft) * f.transpose();
    const Mat3 h = -slope * (Mat3::Identity() - F / 2 + c * F * F);
    u.hessian = (h + h.transpose()) / 2;
    return u;
  }
};

}  // namespace elamin
