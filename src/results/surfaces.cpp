#include "results/surfaces.hpp"

#include "core/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace elamin {

namespace {

/// Directions on the shortest arc between two unit vectors, ends included.
std::vector<Vec3> arc(const Vec3& from, const Vec3& to, int parts) {
  const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
  std::vector<Vec3> all;
  for (int k = 0; k <= parts; ++k) {
    const double t = angle * k / parts;
    all.push_back(k == 0 ? from : k == parts ? to : Vec3((std::sin(angle - t) * from + std::sin(t) * to) / std::sin(angle)));
  }
  return all;
}

class Builder {
 public:
  Builder(const RoundedShape& shape, int arcs) : shape_(shape), arcs_(arcs) {}

  Surface polyhedron() {
    for (const RoundedShape::Face& f : shape_.faces) {
      std::vector<int> corners;
      for (const int v : f.corners) corners.push_back(point(v, f.normal));
      surface_.polygons.push_back(std::move(corners));
    }
    for (const RoundedShape::Edge& e : shape_.edges) {
      if (e.flat) continue;
      const std::vector<Vec3> around = arc(normal(e.left), normal(e.right), arcs_);
      for (int k = 0; k < arcs_; ++k)
        surface_.polygons.push_back({point(e.to, around[k]), point(e.from, around[k]), point(e.from, around[k + 1]), point(e.to, around[k + 1])});
    }
    for (int v = 0; v < static_cast<int>(shape_.vertices.size()); ++v) fan(v);
    return std::move(surface_);
  }

  /// Rings about the line from one vertex to the other, or of a sphere about z.
  Surface round() {
    const Vec3 &low = shape_.vertices.front(), &high = shape_.vertices.back();
    const Vec3 axis = shape_.vertices.size() > 1 ? Vec3((high - low).normalized()) : Vec3(Vec3::UnitZ());
    const Vec3 e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
    const int around = 4 * arcs_, rings = 2 * arcs_;
    std::vector<Vec3>& x = surface_.points;
    x.push_back(low - shape_.radius * axis);
    for (int ring = 1; ring < 2 * rings + (shape_.vertices.size() > 1 ? 1 : 0); ++ring) {
      const bool upper = shape_.vertices.size() > 1 && ring > rings;
      const double height = pi / 2 * (static_cast<double>(ring - upper) / rings - 1);
      for (int k = 0; k < around; ++k) {
        const double phi = 2 * pi * k / around;
        x.push_back((upper ? high : low) + shape_.radius * (std::sin(height) * axis + std::cos(height) * (std::cos(phi) * e1 + std::sin(phi) * e2)));
      }
    }
    x.push_back(high + shape_.radius * axis);
    const int last = static_cast<int>(x.size()) - 1, count = (last - 1) / around;
    const auto at = [&](int ring, int k) { return 1 + ring * around + k % around; };
    for (int k = 0; k < around; ++k) {
      surface_.polygons.push_back({0, at(0, k + 1), at(0, k)});
      for (int ring = 0; ring + 1 < count; ++ring) surface_.polygons.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)});
      surface_.polygons.push_back({at(count - 1, k), at(count - 1, k + 1), last});
    }
    return std::move(surface_);
  }

 private:
  const Vec3& normal(int face) const { return shape_.faces[face].normal; }

  int point(int vertex, const Vec3& direction) {
    surface_.points.push_back(shape_.vertices[vertex] + shape_.radius * direction);
    return static_cast<int>(surface_.points.size()) - 1;
  }

  // The part of the ball between the normals of the faces around a vertex: rings about their middle.
  void fan(int v) {
    const auto meets = [&](const RoundedShape::Edge& e) { return !e.flat && (e.from == v || e.to == v); };
    Vec3 middle = Vec3::Zero();
    for (const RoundedShape::Edge& e : shape_.edges)
      if (meets(e)) middle += normal(e.left) + normal(e.right);
    middle.normalize();
    const int rings = std::max(1, arcs_ / 2);
    for (const RoundedShape::Edge& e : shape_.edges) {
      if (!meets(e)) continue;
      std::vector<Vec3> side = arc(normal(e.left), normal(e.right), arcs_);
      if (e.to == v) std::reverse(side.begin(), side.end());
      for (int k = 0; k < arcs_; ++k) {
        const std::vector<Vec3> a = arc(middle, side[k + 1], rings), b = arc(middle, side[k], rings);
        surface_.polygons.push_back({point(v, middle), point(v, a[1]), point(v, b[1])});
        for (int r = 1; r < rings; ++r) {
          surface_.polygons.push_back({point(v, a[r]), point(v, a[r + 1]), point(v, b[r + 1])});
          surface_.polygons.push_back({point(v, a[r]), point(v, b[r + 1]), point(v, b[r])});
        }
      }
    }
  }

  const RoundedShape& shape_;
  int arcs_;
  Surface surface_;
};

}  // namespace

Surface surface_of(const RoundedShape& shape, int arcs) {
  Builder builder(shape, arcs);
  return shape.faces.empty() ? builder.round() : builder.polyhedron();
}

void write_picture(const std::string& file, const Model& model, const State& state, const std::string& title) {
  std::vector<Surface> surfaces;
  for (const RoundedShape& s : model.shapes) surfaces.push_back(surface_of(s));
  std::string points, polygons, ids, types;
  std::size_t count = 0, cells = 0, numbers = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Surface& s = surfaces[model.bodies[b].shape];
    const Pose& pose = state.bodies[b];
    for (const Vec3& r : s.points) {
      const Vec3 x = pose.position.hi + pose.rotation * r;
      fmt::format_to(std::back_inserter(points), "{:.9g} {:.9g} {:.9g}\n", x[0], x[1], x[2]);
    }
    for (const std::vector<int>& p : s.polygons) {
      fmt::format_to(std::back_inserter(polygons), "{}", p.size());
      for (const int k : p) fmt::format_to(std::back_inserter(polygons), " {}", count + static_cast<std::size_t>(k));
      polygons += '\n';
      fmt::format_to(std::back_inserter(ids), "{}\n", model.bodies[b].id);
      fmt::format_to(std::back_inserter(types), "{}\n", model.bodies[b].type);
      numbers += p.size() + 1;
    }
    count += s.points.size(), cells += s.polygons.size();
  }
  std::string line = title.substr(0, 200);                      // one line of at most 256 characters
  std::replace(line.begin(), line.end(), '\n', ' ');
  write_text(file, fmt::format("# vtk DataFile Version 3.0\n{}\nASCII\nDATASET POLYDATA\nPOINTS {} double\n{}POLYGONS {} {}\n{}"
                               "CELL_DATA {}\nSCALARS id int 1\nLOOKUP_TABLE default\n{}SCALARS type int 1\nLOOKUP_TABLE default\n{}",
                               line, count, points, cells, numbers, polygons, cells, ids, types));
}

namespace {

constexpr int corners = 48;

Surface square(const Region& wall, const Eigen::AlignedBox3d& box) {
  const Vec3 n = wall.normal, foot = box.center() - n.dot(box.center() - wall.center) * n;
  const Vec3 u = n.unitOrthogonal() * box.diagonal().norm() / 2, v = n.cross(u);
  return {{foot - u - v, foot + u - v, foot + u + v, foot - u + v}, {{0, 1, 2, 3}}};
}

Surface block(const Region& wall) {
  Surface s;
  for (int k = 0; k < 8; ++k) s.points.emplace_back((k & 1 ? wall.hi : wall.lo)[0], (k & 2 ? wall.hi : wall.lo)[1], (k & 4 ? wall.hi : wall.lo)[2]);
  const std::vector<std::vector<int>> faces{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (!wall.open[f]) s.polygons.push_back(faces[f]);
  return s;
}

// A cylinder or a cone: two rings.
Surface tube(const Region& wall, const Eigen::AlignedBox3d& box) {
  const bool cone = wall.shape == Shape::cone;
  const bool ends[] = {std::isfinite(wall.axial_lo), std::isfinite(wall.axial_hi)};
  const double at[] = {ends[0] ? wall.axial_lo : box.min()[wall.axis], ends[1] ? wall.axial_hi : box.max()[wall.axis]};
  const Vec3 axis = Vec3::Unit(wall.axis), u = Vec3::Unit((wall.axis + 1) % 3), v = axis.cross(u);
  Surface s;
  for (int end = 0; end < 2; ++end) {
    Vec3 middle = wall.center;
    middle[wall.axis] = at[end];
    const double radius = cone ? (end ? wall.radius_hi : wall.radius_lo) : wall.radius;
    for (int k = 0; k < corners; ++k)
      s.points.push_back(middle + radius * (std::cos(2 * pi * k / corners) * u + std::sin(2 * pi * k / corners) * v));
  }
  for (int k = 0; k < corners && !wall.open[2]; ++k) s.polygons.push_back({k, (k + 1) % corners, corners + (k + 1) % corners, corners + k});
  for (int end = 0; end < 2; ++end) {
    if (wall.open[end] || !ends[end]) continue;
    std::vector<int> cap(corners);
    for (int k = 0; k < corners; ++k) cap[k] = end * corners + (end ? k : corners - 1 - k);
    s.polygons.push_back(std::move(cap));
  }
  return s;
}

}  // namespace

Surface surface_of(const Region& wall, const Eigen::AlignedBox3d& box) {
  switch (wall.shape) {
    case Shape::plane: return square(wall, box);
    case Shape::block: return block(wall);
    case Shape::cylinder:
    case Shape::cone: return tube(wall, box);
    case Shape::sphere: break;
  }
  RoundedShape ball;
  ball.vertices = {wall.center}, ball.radius = wall.radius;
  return surface_of(ball, corners / 4);
}

}  // namespace elamin
