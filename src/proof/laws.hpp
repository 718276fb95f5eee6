#pragma once
// Gradients and Hessians of the laws in intervals: I is an Interval of doubles or quads. Of positions in boxes the results contain all that
// the laws give anywhere in them. The formulas are those of laws/.
#include "laws/harmonic_bond.hpp"
#include "laws/hertz_contact.hpp"
#include "proof/interval.hpp"

namespace elamin::proof {

/// The numbers of each law, as they are taken: the theorem is about these doubles.
struct Bond { double K, r0, r0_tail; };                       // U = K (r − r₀)², r₀ = r0 + r0_tail
struct Angle { double B, cosine, sine; int kept; };           // U = B (1 − cos φ cos φ₀ − sin φ sin φ₀); kept: coordinate of a plane, or −1
/// Hertz's: U = 2/5 k δ^{5/2}, δ = −gap > 0, with the gap r − distance of two spheres, and of a sphere
struct Contact { double k, distance; };
struct Plane { double k, radius; Vec3 normal, point; };       // … at a plane: n·(x − p) − radius,
/// … at a sphere (axis −1) or a cylinder without ends: ±(|y| − wall_radius) − radius, + outside, − inside, y = x − center across the axis.
struct Round { double k, radius, wall_radius; Vec3 center; int axis; bool inside; };

template <class I>
Vector3<I> across(const Round& law, const Vector3<I>& x) {
  Vector3<I> y = x - law.center.cast<I>();
  if (law.axis >= 0) y[law.axis] = I(0);
  return y;
}

/// The distance of the surfaces; negative: overlap. d: x₁ − x₀, of a wall x.
template <class I> I gap(const Contact& law, const Vector3<I>& d) { return length(d) - I(law.distance); }
template <class I>
I gap(const Plane& law, const Vector3<I>& x) {
  const Vector3<I> n = law.normal.cast<I>(), y = x - law.point.cast<I>();
  return n[0] * y[0] + n[1] * y[1] + n[2] * y[2] - I(law.radius);
}
template <class I>
I gap(const Round& law, const Vector3<I>& x) {
  const I outward = length(across(law, x)) - I(law.wall_radius);
  return (law.inside ? -outward : outward) - I(law.radius);
}

/// Of a law of one edge d = x₁ − x₀ (of a wall d = x):  ∇₁U, and ∇₁∇₁U where it is asked for.
template <class I>
struct OfEdge {
  Vector3<I> gradient;
  Matrix3<I> hessian;
};

/// f′ n and f″ n nᵀ + f′/r (I − n nᵀ).
template <class I>
OfEdge<I> radial(const Vector3<I>& d, const I& r, const I& first, const I& second, bool with_hessian) {
  const Vector3<I> n = d / r;
  OfEdge<I> u{first * n, {}};
  if (!with_hessian) return u;
  const I across = first / r;
  u.hessian = (second - across) * (n * n.transpose()).eval();
  for (int c = 0; c < 3; ++c) u.hessian(c, c) += across;
  return u;
}

template <class I>
OfEdge<I> derivatives(const Bond& law, const Vector3<I>& d, bool with_hessian) {
  const I r = length(d), K(law.K);
  return radial<I>(d, r, HarmonicBond::pull(r, K, I(law.r0) + I(law.r0_tail)), I(2) * K, with_hessian);
}

/// Where δ ≤ 0 all is zero; where the box holds both, the hull of both.
template <class I>
OfEdge<I> derivatives(const Contact& law, const Vector3<I>& d, bool with_hessian) {
  const I overlap = positive(-gap(law, d)), k(law.k);
  return radial<I>(d, length(d), -HertzContact::push(overlap, k), I(1.5) * k * sqrt(overlap), with_hessian);
}

template <class I>
OfEdge<I> derivatives(const Plane& law, const Vector3<I>& x, bool with_hessian) {
  const Vector3<I> n = law.normal.cast<I>();
  const I overlap = positive(-gap(law, x)), k(law.k);
  OfEdge<I> u{-HertzContact::push(overlap, k) * n, {}};
  if (with_hessian) u.hessian = I(1.5) * k * sqrt(overlap) * (n * n.transpose()).eval();
  return u;
}

template <class I>
OfEdge<I> derivatives(const Round& law, const Vector3<I>& x, bool with_hessian) {
  const Vector3<I> y = across(law, x);
  const I overlap = positive(-gap(law, x)), k(law.k), push = HertzContact::push(overlap, k);
  OfEdge<I> u = radial<I>(y, length(y), law.inside ? push : -push, I(1.5) * k * sqrt(overlap), with_hessian);
  if (law.axis >= 0) u.hessian(law.axis, law.axis) = I(0);
  return u;
}

/// Of a law of two edges, u = x₁ − x₀ and w = x₂ − x₁.
template <class I>
struct OfEdges {
  Vector3<I> u, w;
  Matrix3<I> uu, uw, ww;
};

/// With a = u/|u|, b = w/|w|, e the axis about which φ grows (of a plane the unit vector of the coordinate that is kept, else
/// a × b/|a × b|) and M = cos φ₀ I − sin φ₀ [e]×:  U = B (1 − a·M b), and at a fixed e
///   ∂U/∂u = −B/|u| m⊥,   m = M b,   m⊥ = (I − a aᵀ) m,   ∂²U/∂u∂u = B/|u|² [ (a·m)(I − a aᵀ) + a m⊥ᵀ + m⊥ aᵀ ]
///   ∂²U/∂u∂w = −B/(|u||w|) (I − a aᵀ) M (I − b bᵀ)
/// of w the same with b and Mᵀ a. In space e turns with the angle, which adds, with s = |a × b|,
///   −B sin φ₀/(|u|² s) e eᵀ,   −B sin φ₀/(|w|² s) e eᵀ   and   B sin φ₀ (a·b)/(|u||w| s) e eᵀ.
template <class I>
OfEdges<I> derivatives(const Angle& law, const Vector3<I>& u, const Vector3<I>& w, bool with_hessian) {
  const I lu = length(u), lw = length(w), B(law.B), c(law.cosine), s(law.sine);
  const Vector3<I> a = u / lu, b = w / lw;
  const bool turns = law.kept < 0 && law.sine != 0;
  Vector3<I> e = Vector3<I>::Zero();
  I sine(0);
  if (law.kept >= 0) e[law.kept] = I(1);
  if (turns) e = a.cross(b), sine = length(e), e /= sine;
  const Vector3<I> m = c * b + s * b.cross(e), l = c * a + s * e.cross(a);
  const I am = a.dot(m), bl = b.dot(l);
  const Vector3<I> m_across = m - am * a, l_across = l - bl * b;
  OfEdges<I> d{-(B / lu) * m_across, -(B / lw) * l_across, {}, {}, {}};
  if (!with_hessian) return d;
  Matrix3<I> cross;
  cross << I(0), -e[2], e[1], e[2], I(0), -e[0], -e[1], e[0], I(0);
  const Matrix3<I> one = Matrix3<I>::Identity(), A = one - a * a.transpose(), C = one - b * b.transpose();
  const Matrix3<I> M = c * one - s * cross, a_m = a * m_across.transpose(), b_l = b * l_across.transpose();
  d.uu = (B / square(lu)) * (am * A + a_m + a_m.transpose()).eval();
  d.ww = (B / square(lw)) * (bl * C + b_l + b_l.transpose()).eval();
  d.uw = -(B / (lu * lw)) * (A * M * C).eval();
  if (turns) {
    const Matrix3<I> ee = (B * s / sine) * (e * e.transpose()).eval();
    d.uu -= (I(1) / square(lu)) * ee, d.ww -= (I(1) / square(lw)) * ee, d.uw += (a.dot(b) / (lu * lw)) * ee;
  }
  return d;
}

}  // namespace elamin::proof
