// Volume, centre and inertia of a rounded polyhedron, by its pieces.
#include "laws/rounded/shape.hpp"

#include <cmath>

namespace elamin {

namespace {

Mat3 outer(const Vec3& a, const Vec3& b) { return a * b.transpose(); }
Mat3 both(const Vec3& a, const Vec3& b) { return outer(a, b) + outer(b, a); }

/// ∫ 1, x, x xᵀ over a solid.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

/// The core: tetrahedra (p, a, b, c) over the triangles of the faces, with y = x − p.
void add_core(Moments& m, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double det = a.dot(b.cross(c));
  const Vec3 s = a + b + c;
  m.volume += det / 6;
  m.first += det / 24 * s;
  m.second += det / 120 * (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s));
}

/// A slab y = x + z n over a triangle, 0 ≤ z ≤ ρ.
void add_slab(Moments& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double rho) {
  const double area = n.dot((b - a).cross(c - a)) / 2;
  const Vec3 s = a + b + c;
  const Mat3 second = area / 12 * (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s));
  m.volume += rho * area;
  m.first += rho * area / 3 * s + rho * rho / 2 * area * n;
  m.second += rho * second + rho * rho / 2 * area / 3 * both(s, n) + rho * rho * rho / 3 * area * outer(n, n);
}

/// Directions w on an arc of angle φ: ∫ w dψ and ∫ w wᵀ dψ.
struct Arc {
  double angle;
  Vec3 first;
  Mat3 second;
};

/// From the unit vector a to b.
Arc arc(const Vec3& a, const Vec3& b) {
  const double sine = a.cross(b).norm(), cosine = a.dot(b), angle = std::atan2(sine, cosine);
  if (!(sine > 0)) return {0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 c = (b - cosine * a) / sine;                              // across a, towards b
  return {angle, sine * a + (1 - cosine) * c,
          (angle + sine * cosine) / 2 * outer(a, a) + (angle - sine * cosine) / 2 * outer(c, c) +
              sine * sine / 2 * both(a, c)};
}

/// x = p + t (q − p) + r w, 0 ≤ r ≤ ρ, w on an arc across q − p.
void add_edge(Moments& m, const Vec3& p, const Vec3& q, const Arc& w, double rho) {
  const double length = (q - p).norm(), r2 = rho * rho / 2, r3 = rho * rho * rho / 3, r4 = rho * rho * rho * rho / 4;
  const Vec3 s = p + q;
  m.volume += r2 * w.angle * length;
  m.first += r2 * w.angle * length / 2 * s + r3 * length * w.first;
  m.second += r2 * w.angle * length / 6 * (outer(p, p) + outer(q, q) + outer(s, s)) +
              r3 * length / 2 * both(s, w.first) + r4 * length * w.second;
}

/// Directions n on a part Ω of the unit sphere: Ω, ∫ n dΩ, ∫ n nᵀ dΩ.
struct Cone {
  double angle = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

/// x = v + r n, 0 ≤ r ≤ ρ.
void add_vertex(Moments& m, const Vec3& v, const Cone& n, double rho) {
  const double r3 = std::pow(rho, 3) / 3, r4 = std::pow(rho, 4) / 4, r5 = std::pow(rho, 5) / 5;
  m.volume += r3 * n.angle;
  m.first += r3 * n.angle * v + r4 * n.first;
  m.second += r3 * n.angle * outer(v, v) + r4 * both(v, n.first) + r5 * n.second;
}

/// The cones of outward normals of the vertices, polygons on the sphere whose corners are the normals of the faces.
/// Their area is the angle defect 2π − Σ face angles; from Gauss's theorem on the sector of the unit ball, with the
/// sides a → b,
///   ∫ n = ½ Σ ∠(a, b) (a × b)/|a × b|,   ∫ n nᵀ = Ω/3 I + ⅓ Σ (a + b)(a × b)ᵀ/(1 + a·b).
std::vector<Cone> cones(const RoundedShape& shape) {
  std::vector<Cone> all(shape.vertices.size());
  if (shape.faces.empty()) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      // the whole sphere, or half of it about the axis of the rod
      all[k].angle = 4 * pi / static_cast<double>(all.size());
      if (all.size() == 2) all[k].first = pi * (shape.vertices[k] - shape.vertices[1 - k]).normalized();
      all[k].second = all[k].angle / 3 * Mat3::Identity();
    }
    return all;
  }
  for (Cone& c : all) c.angle = 2 * pi;
  for (const RoundedShape::Face& face : shape.faces)
    for (std::size_t k = 0, n = face.corners.size(); k < n; ++k) {
      const Vec3 x = shape.vertices[face.corners[k]];
      const Vec3 a = shape.vertices[face.corners[(k + 1) % n]] - x,
          b = shape.vertices[face.corners[(k + n - 1) % n]] - x;
      all[face.corners[k]].angle -= std::atan2(a.cross(b).norm(), a.dot(b));
    }
  for (Cone& c : all) c.second = c.angle / 3 * Mat3::Identity();
  for (const RoundedShape::Edge& e : shape.edges) {
    const Vec3 a = shape.faces[e.left].normal, b = shape.faces[e.right].normal, c = a.cross(b);   // c along from → to
    if (!(c.norm() > 0)) continue;
    const Vec3 first = std::atan2(c.norm(), a.dot(b)) / 2 * c.normalized();
    const Mat3 second = outer(a + b, c) / (3 * (1 + a.dot(b)));
    all[e.to].first += first, all[e.from].first -= first;
    all[e.to].second += second, all[e.from].second -= second;
  }
  return all;
}

}  // namespace

MassProperties mass_properties(const RoundedShape& shape) {
  const Vec3 p = shape.vertices[0];                                    // moments about a point of the core
  Moments m;
  for (const RoundedShape::Face& face : shape.faces)
    for (std::size_t k = 1; k + 1 < face.corners.size(); ++k) {
      const Vec3 a = shape.vertices[face.corners[0]] - p, b = shape.vertices[face.corners[k]] - p,
          c = shape.vertices[face.corners[k + 1]] - p;
      add_core(m, a, b, c);
      add_slab(m, a, b, c, face.normal, shape.radius);
    }
  for (const RoundedShape::Edge& e : shape.edges) {
    const Vec3 a = shape.vertices[e.from] - p, b = shape.vertices[e.to] - p, u = (b - a).normalized();
    const Arc round{2 * pi, Vec3::Zero(), pi * (Mat3::Identity() - outer(u, u))};
    add_edge(m, a, b, e.left < 0 ? round : arc(shape.faces[e.left].normal, shape.faces[e.right].normal), shape.radius);
  }
  const std::vector<Cone> cone = cones(shape);
  for (std::size_t k = 0; k < cone.size(); ++k) add_vertex(m, shape.vertices[k] - p, cone[k], shape.radius);

  const Vec3 center = m.first / m.volume;
  const Mat3 spread = m.second - m.volume * outer(center, center), even = (spread + spread.transpose()) / 2;
  return {m.volume, p + center, even.trace() * Mat3::Identity() - even};
}

}  // namespace elamin
