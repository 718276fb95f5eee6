#include "laws/rounded/shape.hpp"

#include <cmath>
#include <map>

namespace elamin {

namespace {

// sine of the angle between two faces: an edge that is flat, for corners written with six digits
constexpr double flatness = 1e-5;

/// Vector area of a polygon: twice the sum over a fan of triangles, halved.
Vec3 vector_area(const std::vector<Vec3>& x, const std::vector<int>& corners) {
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    area += (x[corners[k]] - x[corners[0]]).cross(x[corners[k + 1]] - x[corners[0]]) / 2;
  return area;
}

RoundedShape::Face make_face(const std::vector<Vec3>& x, const std::vector<int>& corners) {
  RoundedShape::Face face;
  face.corners = corners;
  face.normal = vector_area(x, corners).normalized();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 side = x[corners[(k + 1) % corners.size()]] - x[corners[k]];
    face.inward.push_back(face.normal.cross(side));
    face.offset += face.normal.dot(x[corners[k]]) / static_cast<double>(corners.size());
  }
  return face;
}

/// The face on the left of every directed side.
std::map<std::array<int, 2>, int> sides(const std::vector<std::vector<int>>& faces) {
  std::map<std::array<int, 2>, int> left;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k)
      left.emplace(std::array{faces[f][k], faces[f][(k + 1) % faces[f].size()]}, static_cast<int>(f));
  return left;
}

std::vector<std::array<int, 2>> edges_of(const CoreMesh& core) {
  if (!core.edges.empty()) return core.edges;
  if (core.vertices.size() == 2) return {{0, 1}};
  std::vector<std::array<int, 2>> edges;
  for (const std::vector<int>& face : core.faces)
    for (std::size_t k = 0; k < face.size(); ++k) {
      const int a = face[k], b = face[(k + 1) % face.size()];
      if (a < b) edges.push_back({a, b});      // met once in each direction: here in that of growing numbers
    }
  return edges;
}

}  // namespace

RoundedShape rounded_shape(const CoreMesh& core, double radius) {
  RoundedShape shape;
  shape.vertices = core.vertices, shape.radius = radius;
  for (const Vec3& x : core.vertices) shape.extent = std::max(shape.extent, x.norm());
  for (const std::vector<int>& corners : core.faces) shape.faces.push_back(make_face(core.vertices, corners));
  const auto left = sides(core.faces);
  for (const auto& [a, b] : edges_of(core)) {
    RoundedShape::Edge edge{a, b, -1, -1, false};
    if (!shape.faces.empty()) {
      edge.left = left.at({a, b}), edge.right = left.at({b, a});
      edge.flat = shape.faces[edge.left].normal.cross(shape.faces[edge.right].normal).norm() < flatness;
    }
    const double length = (core.vertices[b] - core.vertices[a]).norm();
    if (!edge.flat && !(shape.shortest_edge > 0 && shape.shortest_edge < length)) shape.shortest_edge = length;
    shape.edges.push_back(edge);
  }
  return shape;
}

CoreMesh point_core() { return {{Vec3::Zero()}, {}, {}}; }

CoreMesh rod_core(double length) { return {{-length / 2 * Vec3::UnitX(), length / 2 * Vec3::UnitX()}, {}, {}}; }

CoreMesh tetrahedron_core(double edge) {
  const double a = edge / 2, h = edge / std::sqrt(8.0);
  return {{{-a, 0, -h}, {a, 0, -h}, {0, -a, h}, {0, a, h}}, {}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

CoreMesh box_core(const Vec3& sides) {
  CoreMesh core;
  for (int k = 0; k < 8; ++k)
    core.vertices.push_back(Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5).cwiseProduct(sides));
  core.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return core;
}

CoreMesh moved_origin(CoreMesh core, const Vec3& center) {
  for (Vec3& x : core.vertices) x -= center;
  return core;
}

}  // namespace elamin
