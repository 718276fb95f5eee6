#include "laws/rounded/core_distance.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

/// Whether the foot of y on the plane of the face is in the face.
bool above(const RoundedShape& shape, const RoundedShape::Face& face, const Vec3& y) {
  for (std::size_t k = 0; k < face.corners.size(); ++k)
    if (face.inward[k].dot(y - shape.vertices[face.corners[k]]) < 0) return false;
  return true;
}

CoreDistance from_face(const RoundedShape& shape, int f, const Vec3& y, double height) {
  const Vec3& n = shape.faces[f].normal;
  return {height, n, y - height * n, {FeatureKind::face, f}, Vec3::Zero()};
}

CoreDistance from_point(const Vec3& y, const Vec3& b, Feature feature, const Vec3& along) {
  const Vec3 d = y - b;
  const double s = d.norm();
  return {s, s > 0 ? Vec3(d / s) : Vec3::Zero(), b, feature, along};
}

CoreDistance from_edges(const RoundedShape& shape, const Vec3& y, const double* heights) {
  double best = infinity, place = 0;
  int nearest = 0;
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    const Vec3 a = shape.vertices[shape.edges[e].from], u = shape.vertices[shape.edges[e].to] - a, d = y - a;
    const double t = std::clamp(d.dot(u) / u.squaredNorm(), 0.0, 1.0), square = (d - t * u).squaredNorm();
    if (square < best) best = square, place = t, nearest = static_cast<int>(e);
  }
  const RoundedShape::Edge& e = shape.edges[nearest];
  const Vec3 a = shape.vertices[e.from], b = shape.vertices[e.to];
  if (place <= 0) return from_point(y, a, {FeatureKind::vertex, e.from}, Vec3::Zero());
  if (place >= 1) return from_point(y, b, {FeatureKind::vertex, e.to}, Vec3::Zero());
  if (e.flat) return from_face(shape, e.left, y, heights[e.left]);
  return from_point(y, a + place * (b - a), {FeatureKind::edge, nearest}, (b - a).normalized());
}

}  // namespace

double face_heights(const RoundedShape& shape, const Vec3& y, double* out) {
  double largest = -infinity;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    out[f] = shape.faces[f].normal.dot(y) - shape.faces[f].offset;
    largest = std::max(largest, out[f]);
  }
  return largest;
}

CoreDistance core_distance(const RoundedShape& shape, const Vec3& y, const double* heights) {
  if (shape.vertices.size() == 1) return from_point(y, shape.vertices[0], {FeatureKind::vertex, 0}, Vec3::Zero());
  int highest = -1, over = -1;
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f) {
    if (highest < 0 || heights[f] > heights[highest]) highest = f;
    if (heights[f] > 0 && (over < 0 || heights[f] < heights[over]) && above(shape, shape.faces[f], y)) over = f;
  }
  if (highest >= 0 && heights[highest] <= 0) return from_face(shape, highest, y, heights[highest]);
  if (over >= 0) return from_face(shape, over, y, heights[over]);
  return from_edges(shape, y, heights);
}

LinePair::LinePair(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) {
  const Vec3 N = u.cross(v), w = a - b;
  const double D = N.squaredNorm();
  sine2 = D / (u.squaredNorm() * v.squaredNorm());
  if (!(sine2 > 64 * epsilon)) return;
  crossing = true;
  ta = -w.cross(v).dot(N) / D, tb = -w.cross(u).dot(N) / D;
  foot_a = a + ta * u, foot_b = b + tb * v;
  const double side = w.dot(N);
  normal = (side < 0 ? -N : N) / std::sqrt(D);
  distance = std::abs(side) / std::sqrt(D);
}

LineGradients::LineGradients(const LinePair& lines, const Vec3& u, const Vec3& v) {
  const double alpha = u.dot(v), U = u.squaredNorm(), V = v.squaredNorm(), D = U * V * lines.sine2;
  const Vec3 p = lines.distance * lines.normal;
  distance << lines.normal, Vec3::Zero();
  ta << (alpha * v - V * u) / D, -V / D * p;
  tb << (U * v - alpha * u) / D, -alpha / D * p;
  sine2 << Vec3::Zero(), -2 * alpha / (U * V) * v;
}

LineDerivatives::LineDerivatives(const LinePair& lines, const Vec3& u, const Vec3& v) {
  const double alpha = u.dot(v), U = u.squaredNorm(), V = v.squaredNorm();
  const Vec3 N = u.cross(v);
  const double D = N.squaredNorm();
  const Vec3& n = lines.normal;
  const Vec3 p = lines.distance * n;
  const auto both = [](const Vec6& a, const Vec6& b) -> Mat6 { return a * b.transpose() + b * a.transpose(); };

  // δN = δu × v = −[v]× δu.
  Mat3 cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  const Mat3 M = -(Mat3::Identity() - n * n.transpose()) * cross * ((n.dot(N) < 0 ? -1 : 1) / std::sqrt(D));
  distance.gradient << n, Vec3::Zero();
  distance.hessian.topRightCorner<3, 3>() = M;
  distance.hessian.bottomLeftCorner<3, 3>() = M.transpose();
  distance.hessian.bottomRightCorner<3, 3>() = -lines.distance * M.transpose() * M;

  Vec6 da, db, dc;                                                     // of α, β, γ; only β is not linear: δp·δu
  da << Vec3::Zero(), v;
  db << u, p;
  dc << v, Vec3::Zero();
  Mat6 ddb = Mat6::Zero();
  ddb.topRightCorner<3, 3>().setIdentity(), ddb.bottomLeftCorner<3, 3>().setIdentity();
  const Vec6 inverse = 2 * alpha / (D * D) * da;                       // ∇(1/D)
  const Vec6 qa = alpha * dc - V * db, qb = U * dc - alpha * db;
  ta.gradient = qa / D;
  ta.hessian = (both(da, dc) - V * ddb) / D + both(qa, inverse);
  tb.gradient = qb / D;
  tb.hessian = (-both(da, db) - alpha * ddb) / D + both(qb, inverse);
  sine2.gradient = -2 * alpha / (U * V) * da;
  sine2.hessian = -2 / (U * V) * da * da.transpose();
}

}  // namespace elamin
