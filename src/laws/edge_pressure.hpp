#pragma once
#include "laws/law.hpp"

namespace elamin {

/// Pressure on one edge of a closed polygon in a plane with unit normal n:  U = ½ p n·(a × b),  a = x₀ − c, b = x₁ − c:
/// p times the area of the triangle over the edge, of which c is the tip. The sum over the polygon, p A, does not depend
/// on c; near the polygon no digits are lost however far from the origin it is.
///   ∇₀U = ½ p b × n,   ∇₁U = ½ p n × a,   ∇₀∇₁U = −½ p [n]×,   [n]× v = n × v
/// With a × b = a × (x₁ − x₀), where the edge is exact.
/// p [force/length], positive: inwards where the polygon runs counterclockwise about n.
struct EdgePressure {
  static constexpr int sites = 2;
  static constexpr bool anchored = true;
  double p;
  Vec3 n;
  ExactVector c;

  double value(const Points<2>& x) const { return p / 2 * n.dot(arm(x, 0).cross(x.edge(0, 1).hi)); }

  Local<2> derivatives(const Points<2>& x) const {
    Local<2> u;
    u.value = value(x);
    u.gradient = gradient(x, p);
    Mat3 h;
    h << 0, n.z(), -n.y(), -n.z(), 0, n.x(), n.y(), -n.x(), 0;
    u.block(0, 1) = p / 2 * h;
    u.block(1, 0) = -u.block(0, 1);
    return u;
  }

  /// ∂(∇U)/∂λ where p changes with a parameter λ.
  Eigen::Matrix<double, 6, 1> gradient_rate(const Points<2>& x, const EdgePressure& rate) const { return gradient(x, rate.p); }

 private:
  Vec3 arm(const Points<2>& x, int i) const { return (ExactVector{x.position.col(i), x.low.col(i)} - c).hi; }
  Eigen::Matrix<double, 6, 1> gradient(const Points<2>& x, double pressure) const {
    const Vec3 a = arm(x, 0), b = arm(x, 1);
    Eigen::Matrix<double, 6, 1> g;
    g.head<3>() = pressure / 2 * b.cross(n);
    g.tail<3>() = pressure / 2 * n.cross(a);
    return g;
  }
};

static_assert(AnchoredLaw<EdgePressure> && ChangingLaw<EdgePressure>);

}  // namespace elamin
