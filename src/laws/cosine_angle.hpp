#pragma once
#include "laws/law.hpp"

#include <limits>

namespace elamin {

/// Cosine angle  U = B (1 + cos θ), θ the angle at site 1 between sites 0 and 2; at rest straight, θ = π.
/// With u = x₁ − x₀, w = x₂ − x₁, a = u/|u|, b = w/|w| and the turn φ = π − θ:  U = B (1 − a·b) = B (1 − cos φ).
///   ∂U/∂u = −B b⊥/|u|,   b⊥ = b − (a·b) a = n × a,      n = a × b
///   ∂U/∂w = −B a⊥/|w|,   a⊥ = a − (a·b) b = b × n
///   ∂²U/∂u∂u = B/|u|² [ (a·b)(I − a aᵀ) + a b⊥ᵀ + b⊥ aᵀ ],   ∂²U/∂w∂w the same with a ↔ b, u ↔ w
///   ∂²U/∂u∂w = −B/(|u||w|) (I − a aᵀ)(I − b bᵀ)
/// and ∇₀ = −∂/∂u, ∇₁ = ∂/∂u − ∂/∂w, ∇₂ = ∂/∂w.  B [energy].  Smooth but where two sites meet: U = +inf there.
/// Near the straight angle n = u × (w − u)/(|u||w|), near the folded one n = u × (w + u)/(|u||w|): the second difference
/// and the closing side are formed exactly, so forces and energies keep their digits for any small turn or opening.
/// Source: Guerra 2021, eq. (9).
struct CosineAngle {
  static constexpr int sites = 3;
  double B;

  double value(const Points<3>& x) const {
    const Turn t(x);
    return t.defined ? B * t.versine() : std::numeric_limits<double>::infinity();
  }

  Local<3> derivatives(const Points<3>& x) const {
    Local<3> U;
    const Turn t(x);
    if (!t.defined) {
      U.value = std::numeric_limits<double>::infinity();
      return U;
    }
    U.value = B * t.versine();
    const Vec3 a_perp = t.b.cross(t.n), b_perp = t.n.cross(t.a);
    const Vec3 g_u = -B / t.length_u * b_perp, g_w = -B / t.length_w * a_perp;
    U.force_part(0) = -g_u;
    U.force_part(1) = g_u - g_w;
    U.force_part(2) = g_w;

    const Mat3 A = Mat3::Identity() - t.a * t.a.transpose(), C = Mat3::Identity() - t.b * t.b.transpose();
    const Mat3 ab = t.a * b_perp.transpose(), ba = t.b * a_perp.transpose();
    const Mat3 uu = B / (t.length_u * t.length_u) * (t.cosine * A + (ab + ab.transpose()));
    const Mat3 ww = B / (t.length_w * t.length_w) * (t.cosine * C + (ba + ba.transpose()));
    const Mat3 uw = -B / (t.length_u * t.length_w) * (A * C);
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

 private:
  struct Turn {
    bool defined = false;
    double length_u = 0, length_w = 0, cosine = 0;       // cosine = a·b = cos φ = −cos θ
    Vec3 a, b, n;                                        // n = a × b, |n| = sin φ

    explicit Turn(const Points<3>& x) {
      const ExactVector u = x.edge(0, 1), w = x.edge(1, 2);
      length_u = u.hi.norm(), length_w = w.hi.norm();
      if (!(length_u > 0 && length_w > 0)) return;
      defined = true;
      a = u.hi / length_u, b = w.hi / length_w;
      cosine = a.dot(b);
      const ExactVector small = cosine > 0 ? w - u : w + u;
      n = a.cross((small.hi + small.lo) / length_w);
    }
    /// 1 − cos φ = sin²φ/(1 + cos φ), without cancellation.
    double versine() const { return cosine > 0 ? n.squaredNorm() / (1 + cosine) : 1 - cosine; }
  };
};

static_assert(Law<CosineAngle>);

}  // namespace elamin
