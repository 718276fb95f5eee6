#pragma once
// Bodies and poses for tests, the same on every call.
#include "laws/rounded/closest.hpp"

#include <random>
#include <string>
#include <vector>

namespace elamin {

inline Vec3 random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random);
  return {x, y, normal(random)};
}

inline Eigen::Quaterniond random_rotation(std::mt19937& random) {
  const Vec3 v = random_vector(random);
  return Eigen::Quaterniond(std::normal_distribution<double>()(random), v.x(), v.y(), v.z()).normalized();
}

/// A core without symmetry: a pyramid on a square, with the tip aside.
inline CoreMesh pyramid_core() {
  return {{{0.6, 0.6, -0.3}, {-0.6, 0.6, -0.3}, {-0.6, -0.6, -0.3}, {0.6, -0.6, -0.3}, {0.2, -0.1, 0.8}}, {},
          {{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

struct NamedShape {
  std::string name;
  RoundedShape shape;
};

/// One of each kind, of sizes about 1.
inline const std::vector<NamedShape>& test_shapes() {
  static const std::vector<NamedShape> all{{"sphere", rounded_shape(point_core(), 0.4)},
                                           {"rod", rounded_shape(rod_core(1.5), 0.2)},
                                           {"tetrahedron", rounded_shape(tetrahedron_core(1.4), 0.15)},
                                           {"box", rounded_shape(box_core({1.0, 0.8, 1.3}), 0.1)},
                                           {"pyramid", rounded_shape(pyramid_core(), 0.12)}};
  return all;
}

inline RoundedBody placed(const RoundedShape& shape, const Vec3& x, const Eigen::Quaterniond& q) {
  return {&shape, {{x, Vec3::Zero()}, q}};
}

/// The shape with every length times s.
inline RoundedShape scaled(const RoundedShape& shape, double s) {
  CoreMesh core;
  for (const Vec3& x : shape.vertices) core.vertices.push_back(s * x);
  for (const auto& e : shape.edges) core.edges.push_back({e.from, e.to});
  for (const auto& f : shape.faces) core.faces.push_back(f.corners);
  return rounded_shape(core, s * shape.radius);
}

/// Two bodies.
struct Couple {
  RoundedBody a, b;
  double gap() const { return core_separation(a, b) - a.shape->radius - b.shape->radius; }
};

/// Turned at random, B at some distance in a random direction such that the gap of the surfaces is as given (bisection;
/// the gap grows along a direction once the centres are apart).
inline Couple couple(const RoundedShape& a, const RoundedShape& b, double gap, std::mt19937& random) {
  const Vec3 from = random_vector(random), direction = random_vector(random).normalized();
  Couple c{placed(a, from, random_rotation(random)), placed(b, from, random_rotation(random))};
  double lo = 0, hi = a.bounding_radius() + b.bounding_radius() + std::abs(gap);
  for (int k = 0; k < 60; ++k) {
    const double middle = (lo + hi) / 2;
    c.b.pose.position.hi = from + middle * direction;
    (c.gap() < gap ? lo : hi) = middle;
  }
  return c;
}

inline Couple moved(const Couple& c, const Eigen::Matrix<double, 12, 1>& step) {
  return {{c.a.shape, moved(c.a.pose, step.segment<3>(0), step.segment<3>(3))},
          {c.b.shape, moved(c.b.pose, step.segment<3>(6), step.segment<3>(9))}};
}

}  // namespace elamin
