#include "results/wall_surface.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {
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
