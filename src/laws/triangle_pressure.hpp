#pragma once
#include "laws/law.hpp"

namespace elamin {

/// Pressure on one triangle of a surface:  U = p a·(b × c)/6,  a = x₀ − t, b = x₁ − t, c = x₂ − t: p times the volume of the
/// tetrahedron over the triangle, of which t is the tip. The sum over a closed surface, p V, does not depend on t, nor do the forces
/// on particles all around which there are triangles: a third of p times the area vector of these.
///   ∇₀U = p b × c/6,   ∇₀∇₁U = −p [c]×/6,   ∇₀∇₂U = p [b]×/6,   and so on around, [c]× v = c × v
/// With b × c = b × (x₂ − x₁), where the edge is exact: what is lost where t is far grows with its distance in edges.
/// p [force/length²], positive: against the side from which x₀, x₁, x₂ run counterclockwise.
struct TrianglePressure {
  static constexpr int sites = 3;
  static constexpr bool anchored = true;
  double p;
  Vec3 tip;

  double value(const Points<3>& x) const { return p / 6 * arm(x, 0).dot(x.edge(0, 1).hi.cross(x.edge(0, 2).hi)); }

  Local<3> derivatives(const Points<3>& x) const {
    Local<3> u;
    u.value = value(x);
    u.gradient = gradient(x, p);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const Vec3 v = p / 6 * arm(x, k);
      Mat3 h;
      h << 0, v.z(), -v.y(), -v.z(), 0, v.x(), v.y(), -v.x(), 0;
      u.block(i, j) = h;
      u.block(j, i) = -h;
    }
    return u;
  }

  /// ∂(∇U)/∂λ where p changes with a parameter λ.
  Eigen::Matrix<double, 9, 1> gradient_rate(const Points<3>& x, const TrianglePressure& rate) const { return gradient(x, rate.p); }

 private:
  Vec3 arm(const Points<3>& x, int i) const { return (ExactVector{x.position.col(i), x.low.col(i)} - ExactVector{tip, Vec3::Zero()}).hi; }
  Eigen::Matrix<double, 9, 1> gradient(const Points<3>& x, double pressure) const {
    Eigen::Matrix<double, 9, 1> g;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      g.segment<3>(3 * i) = pressure / 6 * arm(x, j).cross(x.edge(j, k).hi);
    }
    return g;
  }
};

static_assert(AnchoredLaw<TrianglePressure> && ChangingLaw<TrianglePressure>);

}  // namespace elamin
