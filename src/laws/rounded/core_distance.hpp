#pragma once
// How far a point is from a core, and how far the lines of two edges are from each other.
#include "laws/rounded/shape.hpp"

namespace elamin {

enum class FeatureKind { vertex, edge, face };

/// A vertex, edge or face of a shape, by its place in the shape's list.
struct Feature {
  FeatureKind kind = FeatureKind::vertex;
  int index = 0;
  bool operator==(const Feature&) const = default;
};

/// The signed distance s of a point y from a core and the nearest feature of it, in the frame of the core.
///   n = ∇s = (y − b)/s, b the nearest point; ∇²s = (P − n nᵀ)/s with P = I − (projector on the feature),
/// so P n = n: a face has P = n nᵀ, an edge with unit direction e has P = I − e eᵀ, a vertex P = I, and ∂b/∂y = I − P.
/// Inside a polyhedron s = −(depth below the nearest face). s is C¹ outside; its gradient jumps inside where the
/// nearest face does. On a rod or a sphere's centre itself there is no direction: n = 0 and the curvature is taken as
/// zero.
struct CoreDistance {
  double value = 0;
  Vec3 normal = Vec3::Zero();
  Vec3 nearest = Vec3::Zero();
  Feature feature;
  Vec3 along = Vec3::Zero();                   // unit direction of the edge, if the feature is one

  /// I − P: moves of the point that move the nearest point alike.
  Mat3 tangent() const {
    if (feature.kind == FeatureKind::face) return Mat3::Identity() - normal * normal.transpose();
    if (feature.kind == FeatureKind::edge) return along * along.transpose();
    return Mat3::Zero();
  }
  /// ∇²s.
  Mat3 curvature() const {
    if (feature.kind == FeatureKind::face || !(value > 0)) return Mat3::Zero();
    return (Mat3::Identity() - tangent() - normal * normal.transpose()) / value;
  }
};

/// Of the point y. `heights`: n·y − offset of every face of the shape.
CoreDistance core_distance(const RoundedShape& shape, const Vec3& y, const double* heights);

/// Heights of y above the planes of all faces, written to `out`; returns the largest, −∞ if the shape has no faces.
/// It is never larger than the distance of y.
double face_heights(const RoundedShape& shape, const Vec3& y, double* out);

/// The lines a + t_a u and b + t_b v at their common perpendicular: u an edge of one core, v of the other, b fixed.
///   N = u × v,   t_a = −((a − b) × v)·N/|N|²,   t_b = −((a − b) × u)·N/|N|²,   p = (a + t_a u) − (b + t_b v) = d n
/// Derivatives by δp, the motion of the foot carried by the first body, and δu, the turning of its edge (6 variables; v
/// does not move and |u|² does not change), with α = u·v, U = u·u, V = v·v, D = U V − α², β = u·p, γ = v·p, β = γ = 0
/// here:
///   d = p·n:              ∇d = (n, 0),   δ²d = 2 δp·δn − d |δn|²,   δn = M δu,  M = ∓(I − n nᵀ)[v]×/|N|
///   t_a: (α γ − V β)/D,   t_b: (U γ − α β)/D,   sin² = 1 − α²/(U V)
/// Lines that are parallel to rounding have no common perpendicular: `crossing` is false and nothing else is set.
struct LinePair {
  bool crossing = false;
  double distance = 0;                         // d ≥ 0, or < 0 if the sign is turned
  Vec3 normal = Vec3::Zero();                  // n, from b's line to a's
  double ta = 0, tb = 0, sine2 = 0;
  Vec3 foot_a = Vec3::Zero(), foot_b = Vec3::Zero();

  LinePair() = default;
  LinePair(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v);

  /// n ← −n, d ← −d: for cores that overlap.
  void flip() { normal = -normal, distance = -distance; }
  /// Both feet between the ends of their edges.
  bool within() const { return crossing && ta > 0 && ta < 1 && tb > 0 && tb < 1; }
};

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// A function of (p, u) with first and second derivatives.
struct LineFunction {
  Vec6 gradient = Vec6::Zero();
  Mat6 hessian = Mat6::Zero();
};

/// The gradients of what a LinePair holds.
struct LineGradients {
  Vec6 distance, ta, tb, sine2;
  LineGradients(const LinePair& lines, const Vec3& u, const Vec3& v);
};

/// Its derivatives.
struct LineDerivatives {
  LineFunction distance, ta, tb, sine2;
  LineDerivatives(const LinePair& lines, const Vec3& u, const Vec3& v);
};

}  // namespace elamin
