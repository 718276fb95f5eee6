// What is wrong with a core: bad numbers, bad indices, and whatever is not a convex polyhedron turned outward.
#include "laws/rounded/shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

namespace elamin {

namespace {

using Sentences = std::vector<std::string>;
using Side = std::array<int, 2>;

constexpr double tolerance = 1e-8;             // of the size of the core
constexpr double planar_within = 3e-6;         // of the size of the core: numbers written with six digits will do

Sentences wrong_numbers(const CoreMesh& core, double radius, int first) {
  Sentences wrong;
  if (!(std::isfinite(radius) && radius > 0))
    wrong.push_back(fmt::format("the rounding radius is {}; allowed: > 0", radius));
  for (std::size_t k = 0; k < core.vertices.size(); ++k)
    if (!core.vertices[k].allFinite()) wrong.push_back(fmt::format("vertex {} is not finite", first + k));
  if (core.vertices.empty())
    wrong.push_back("there is no vertex; allowed: 1 (sphere), 2 (rod), 4 or more (polyhedron)");
  if (core.vertices.size() == 3)
    wrong.push_back("three vertices span no volume; allowed: 1 (sphere), 2 (rod), 4 or more (polyhedron)");
  return wrong;
}

double size_of(const std::vector<Vec3>& x) {
  double size = 0;
  for (const Vec3& v : x) size = std::max(size, (v - x[0]).norm());
  return size;
}

Sentences wrong_indices(const CoreMesh& core, int first) {
  Sentences wrong;
  const int n = static_cast<int>(core.vertices.size());
  const auto outside = [n](int k) { return k < 0 || k >= n; };
  for (std::size_t f = 0; f < core.faces.size(); ++f) {
    const std::vector<int>& face = core.faces[f];
    if (face.size() < 3) wrong.push_back(fmt::format("face {} has {} vertices; allowed: 3 or more", first + f, face.size()));
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (outside(face[k]))
        wrong.push_back(fmt::format("face {} names vertex {}; allowed: {} to {}", first + f, first + face[k], first, first + n - 1));
      for (std::size_t m = 0; m < k; ++m)
        if (face[m] == face[k]) wrong.push_back(fmt::format("face {} names vertex {} twice", first + f, first + face[k]));
    }
  }
  for (std::size_t e = 0; e < core.edges.size(); ++e) {
    const Side& edge = core.edges[e];
    for (const int k : edge)
      if (outside(k)) wrong.push_back(fmt::format("edge {} names vertex {}; allowed: {} to {}", first + e, first + k, first, first + n - 1));
    if (edge[0] == edge[1]) wrong.push_back(fmt::format("edge {} runs from vertex {} to itself", first + e, first + edge[0]));
  }
  const double size = n > 0 ? size_of(core.vertices) : 0;
  for (int k = 0; k < n; ++k)
    for (int m = 0; m < k; ++m)
      if (!((core.vertices[k] - core.vertices[m]).norm() > tolerance * size))
        wrong.push_back(fmt::format("vertices {} and {} are at the same place", first + m, first + k));
  return wrong;
}

Sentences wrong_simple(const CoreMesh& core) {
  Sentences wrong;
  if (!core.faces.empty()) wrong.push_back("a sphere or rod has no faces");
  if (core.vertices.size() == 1 && !core.edges.empty()) wrong.push_back("a sphere has no edges");
  if (core.vertices.size() == 2 && core.edges.size() > 1) wrong.push_back("a rod has one edge");
  return wrong;
}

/// Every side is met once in each direction; given edges are the sides.
Sentences wrong_sides(const CoreMesh& core, int first) {
  Sentences wrong;
  std::map<Side, int> met;
  std::vector<bool> used(core.vertices.size());
  for (const std::vector<int>& face : core.faces)
    for (std::size_t k = 0; k < face.size(); ++k) {
      ++met[{face[k], face[(k + 1) % face.size()]}];
      used[face[k]] = true;
    }
  for (const auto& [side, times] : met) {
    if (times > 1) wrong.push_back(fmt::format("{} faces run along {} to {} in the same direction; allowed: 1", times,
        first + side[0], first + side[1]));
    if (!met.contains({side[1], side[0]}))
      wrong.push_back(fmt::format("the mesh is open: one face only at the side {} to {}", first + side[0], first + side[1]));
  }
  for (std::size_t k = 0; k < used.size(); ++k)
    if (!used[k]) wrong.push_back(fmt::format("vertex {} belongs to no face", first + k));
  if (core.edges.empty()) return wrong;
  std::map<Side, int> given;
  for (const Side& e : core.edges) ++given[{std::min(e[0], e[1]), std::max(e[0], e[1])}];
  for (const auto& [edge, times] : given) {
    if (times > 1) wrong.push_back(fmt::format("the edge {} to {} is given {} times", first + edge[0], first + edge[1], times));
    if (!met.contains(edge) && !met.contains({edge[1], edge[0]}))
      wrong.push_back(fmt::format("the edge {} to {} is no side of a face", first + edge[0], first + edge[1]));
  }
  for (const auto& [side, times] : met)
    if (side[0] < side[1] && !given.contains(side))
      wrong.push_back(fmt::format("the side {} to {} of a face is missing among the edges", first + side[0], first + side[1]));
  return wrong;
}

/// Planar faces, each with the whole core on its inner side.
Sentences wrong_faces(const CoreMesh& core, int first) {
  Sentences wrong;
  const double size = size_of(core.vertices);
  bool thick = false;
  for (std::size_t f = 0; f < core.faces.size(); ++f) {
    const std::vector<int>& face = core.faces[f];
    const Vec3 p = core.vertices[face[0]];
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      area += (core.vertices[face[k]] - p).cross(core.vertices[face[k + 1]] - p);
    if (!(area.norm() > tolerance * size * size)) {
      wrong.push_back(fmt::format("face {} has no area", first + f));
      continue;
    }
    const Vec3 n = area.normalized();
    bool planar = true, turned = true;
    for (const int k : face) planar = planar && std::abs(n.dot(core.vertices[k] - p)) <= planar_within * size;
    if (!planar) {
      wrong.push_back(fmt::format("face {} is not planar", first + f));
      continue;
    }
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3 a = core.vertices[face[k]], b = core.vertices[face[(k + 1) % face.size()]],
          c = core.vertices[face[(k + 2) % face.size()]];
      turned = turned && n.dot((b - a).cross(c - b)) > -tolerance * size * size;
    }
    if (!turned) wrong.push_back(fmt::format("face {} is not convex", first + f));
    double above = 0, below = 0;
    for (const Vec3& x : core.vertices) above = std::max(above, n.dot(x - p)), below = std::max(below, -n.dot(x - p));
    thick = thick || above > planar_within * size || below > planar_within * size;
    if (above <= planar_within * size) continue;
    wrong.push_back(below <= planar_within * size
                        ? fmt::format("face {} looks inward; allowed: vertices counter-clockwise seen from outside", first + f)
                        : fmt::format("the core is not convex: vertices stand on both sides of face {}", first + f));
  }
  if (wrong.empty() && !thick) wrong.push_back("the core has no volume");
  return wrong;
}

/// At a corner the angles of the faces sum to less than a full turn.
Sentences wrong_corners(const CoreMesh& core, int first) {
  std::vector<double> defect(core.vertices.size(), 2 * std::numbers::pi);
  for (const std::vector<int>& face : core.faces)
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3 x = core.vertices[face[k]];
      const Vec3 a = core.vertices[face[(k + 1) % face.size()]] - x,
          b = core.vertices[face[(k + face.size() - 1) % face.size()]] - x;
      defect[face[k]] -= std::atan2(a.cross(b).norm(), a.dot(b));
    }
  Sentences wrong;
  for (std::size_t k = 0; k < defect.size(); ++k)
    if (!(defect[k] > tolerance)) wrong.push_back(fmt::format("vertex {} is no corner of the core: leave it out", first + k));
  return wrong;
}

}  // namespace

std::vector<std::string> mistakes(const CoreMesh& core, double radius, int first) {
  Sentences wrong = wrong_numbers(core, radius, first);
  const auto add = [&wrong](const Sentences& more) { wrong.insert(wrong.end(), more.begin(), more.end()); };
  if (wrong.empty()) add(wrong_indices(core, first));
  if (core.vertices.size() < 3) add(wrong_simple(core));
  if (!wrong.empty() || core.vertices.size() < 3) return wrong;
  add(wrong_sides(core, first));
  add(wrong_faces(core, first));
  if (wrong.empty()) add(wrong_corners(core, first));
  return wrong;
}

}  // namespace elamin
