#include "laws/rounded/lammps_hits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elamin {

namespace {

constexpr double eps = lammps_epsilon;
using OnHit = std::function<void(const LammpsHit&)>;

/// The angles that the sides subtend at h, in the plane of the face, sum to a full turn. Too near to a corner: not
/// inside.
bool inside_face(const LammpsPlaced& body, const RoundedShape::Face& face, const Vec3& h) {
  double sum = 0;
  for (std::size_t k = 0; k < face.corners.size(); ++k) {
    const Vec3 a = body.vertices[face.corners[k]] - h,
        b = body.vertices[face.corners[(k + 1) % face.corners.size()]] - h;
    const double product = a.norm() * b.norm();
    if (product < eps) return false;
    sum += std::acos(std::clamp(a.dot(b) / product, -1.0, 1.0));
  }
  return std::abs(sum - 2 * std::numbers::pi) < eps;
}

/// Whether h of its plane is in the triangle of the face's first three corners.
bool inside_triangle(const LammpsPlaced& body, const RoundedShape::Face& face, const Vec3& h) {
  const Vec3 a = body.vertices[face.corners[0]], b = body.vertices[face.corners[1]], c = body.vertices[face.corners[2]];
  const Vec3 n = (b - a).cross(c - a);
  return n.dot((b - a).cross(h - a)) >= 0 && n.dot((c - b).cross(h - b)) >= 0 && n.dot((a - c).cross(h - c)) >= 0;
}

struct Line {
  Vec3 from, to;

  Vec3 foot(const Vec3& x) const {
    const Vec3 u = (to - from).normalized();
    return from + (x - from).dot(u) * u;
  }

  /// Of h on the line, by the first coordinate in which the line is not constant.
  double parameter(const Vec3& h) const {
    for (int c = 0; c < 3; ++c)
      if (from[c] != to[c]) return (h[c] - from[c]) / (to[c] - from[c]);
    return 0;
  }
};

Line line(const LammpsPlaced& body, int e) {
  return {body.vertices[body.shape->edges[e].from], body.vertices[body.shape->edges[e].to]};
}

bool between_ends(double t) { return t >= 0 && t <= 1; }

/// A sphere against everything else.
void sphere_hits(int sphere, const LammpsPlaced& s, const LammpsPlaced& body, double cutoff, const OnHit& hit) {
  const Vec3& c = s.center;
  const Feature point{FeatureKind::vertex, 0};
  for (int f = 0; f < static_cast<int>(body.normals.size()); ++f) {
    const RoundedShape::Face& face = body.shape->faces[f];
    const Vec3& n = body.normals[f];
    const Vec3& p = body.vertices[face.corners[0]];
    const double height = n.dot(c - p);
    if (height * n.dot(body.center - p) > 0) continue;
    const Vec3 foot = c - height * n;
    if (inside_face(body, face, foot)) hit({sphere, point, {FeatureKind::face, f}, c, foot, std::abs(height)});
  }
  std::vector<bool> met(body.vertices.size());
  for (int e = 0; e < static_cast<int>(body.shape->edges.size()); ++e) {
    const Line edge = line(body, e);
    Vec3 foot = edge.foot(c);
    const double t = edge.parameter(foot);
    if ((c - foot).norm() > s.shape->radius + body.shape->radius + cutoff || !between_ends(t)) continue;
    if (t < eps || 1 - t < eps) {
      const int end = t < eps ? body.shape->edges[e].from : body.shape->edges[e].to;
      if (met[end]) continue;
      met[end] = true;
      foot = body.vertices[end];
    }
    hit({sphere, point, {FeatureKind::edge, e}, c, foot, (c - foot).norm()});
  }
}

/// The edges of body a (0: i, 1: j) against the faces of the other.
void edges_on_faces(int first_of, const LammpsPlaced& a, const LammpsPlaced& b, double cutoff, const OnHit& hit) {
  const std::size_t faces = b.normals.size();
  std::vector<bool> met(a.vertices.size());
  // of a's vertices and of b's center above b's faces
  std::vector<double> heights(a.vertices.size() * faces), sides(faces);
  for (std::size_t f = 0; f < faces; ++f) {
    const Vec3& corner = b.vertices[b.shape->faces[f].corners[0]];
    sides[f] = b.normals[f].dot(b.center - corner);
    for (std::size_t k = 0; k < a.vertices.size(); ++k)
      heights[k * faces + f] = b.normals[f].dot(a.vertices[k] - corner);
  }
  for (int e = 0; e < static_cast<int>(a.shape->edges.size()); ++e) {
    const std::array<int, 2> ends{a.shape->edges[e].from, a.shape->edges[e].to};
    for (int f = 0; f < static_cast<int>(faces); ++f) {
      const RoundedShape::Face& face = b.shape->faces[f];
      const Feature on{FeatureKind::face, f};
      const std::array<double, 2> height{heights[ends[0] * faces + f], heights[ends[1] * faces + f]};
      if (height[0] * sides[f] > 0 && height[1] * sides[f] > 0) continue;
      const auto foot = [&](int k) -> Vec3 { return a.vertices[ends[k]] - height[k] * b.normals[f]; };
      if (std::abs(height[1] - height[0]) >= eps) {
        const double t = height[0] / (height[0] - height[1]);
        if (between_ends(t)) {
          const Vec3 crossing = a.vertices[ends[0]] + t * (a.vertices[ends[1]] - a.vertices[ends[0]]);
          if (!inside_triangle(b, face, crossing)) continue;
          const int k = std::abs(height[0]) < std::abs(height[1]) ? 0 : 1;
          hit({first_of, {FeatureKind::edge, e}, on, a.vertices[ends[k]], foot(k), std::abs(height[k]), true});
          continue;
        }
      }
      for (int k = 0; k < 2; ++k) {
        if (met[ends[k]] || std::abs(height[k]) > cutoff || !inside_face(b, face, foot(k))) continue;
        met[ends[k]] = true;
        hit({first_of, {FeatureKind::vertex, ends[k]}, on, a.vertices[ends[k]], foot(k), std::abs(height[k])});
      }
    }
  }
}

struct Meeting {
  bool found = false;
  Vec3 on_a, on_b;
};

/// Parallel edges. Both ends of a within b: their middle; one: that one; none, but b within a: the middle of b and the
/// point of a whose foot it is.
Meeting beside(const Line& a, const Line& b) {
  const Vec3 p = b.foot(a.from), q = b.foot(a.to);
  const double s = b.parameter(p), t = b.parameter(q);
  const bool first = between_ends(s), second = between_ends(t);
  if (first && second) return {true, (a.from + a.to) / 2, (p + q) / 2};
  if (first) return {true, a.from, p};
  if (second) return {true, a.to, q};
  if ((s < 0) == (t < 0)) return {};
  return {true, a.from + (0.5 - s) / (t - s) * (a.to - a.from), (b.from + b.to) / 2};
}

void edges_on_edges(const LammpsPlaced& i, const LammpsPlaced& j, double cutoff, const OnHit& hit) {
  for (int ei = 0; ei < static_cast<int>(i.shape->edges.size()); ++ei)
    for (int ej = 0; ej < static_cast<int>(j.shape->edges.size()); ++ej) {
      const Line a = line(j, ej), b = line(i, ei);
      const Vec3 u = a.to - a.from, v = b.to - b.from;
      // Points between the ends are farther apart than cutoff, also where r is that of another point of nearly parallel
      // edges.
      const double far = 0.55 * (u.norm() + v.norm()) + cutoff;
      if ((a.from + a.to - b.from - b.to).squaredNorm() > 4 * far * far) continue;
      const bool parallel = std::abs(std::abs(u.normalized().dot(v.normalized())) - 1) < eps;
      Meeting m;
      double r = 0;
      if (parallel) {
        r = (a.from - b.foot(a.from)).norm();
        m = beside(a, b);
      } else {
        const LinePair lines(a.from, u, b.from, v);
        r = lines.distance;
        m = {between_ends(a.parameter(lines.foot_a)) && between_ends(b.parameter(lines.foot_b)), lines.foot_a, lines.foot_b};
      }
      if (!m.found || r < eps || !(r < cutoff)) continue;
      hit({1, {FeatureKind::edge, ej}, {FeatureKind::edge, ei}, m.on_a, m.on_b, r, false, parallel});
    }
}

}  // namespace

LammpsPlaced::LammpsPlaced(const RoundedBody& body, const Vec3& at) : shape(body.shape), center(at) {
  const Mat3 R = body.pose.rotation.toRotationMatrix();
  for (const Vec3& r : shape->vertices) vertices.push_back(at + R * r);
  for (const RoundedShape::Face& f : shape->faces) normals.push_back(R * f.normal);
}

void lammps_hits(const LammpsPlaced& i, const LammpsPlaced& j, double cutoff, const OnHit& hit) {
  const double within = i.shape->radius + j.shape->radius + cutoff;
  const Feature point{FeatureKind::vertex, 0};
  if (i.sphere() && j.sphere()) hit({0, point, point, i.center, j.center, (i.center - j.center).norm()});
  else if (i.sphere()) sphere_hits(0, i, j, cutoff, hit);
  else if (j.sphere()) sphere_hits(1, j, i, cutoff, hit);
  else {
    edges_on_faces(0, i, j, within, hit);
    edges_on_faces(1, j, i, within, hit);
    edges_on_edges(i, j, within, hit);
  }
}

}  // namespace elamin
