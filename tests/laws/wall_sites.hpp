#pragma once
// Walls of every shape and a place on each of their faces, edges and corners.
#include "laws/wall_contact.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace elamin {

/// A sphere at a wall as a law on one site.
struct AtWall {
  static constexpr int sites = 1;
  WallContact wall;
  double radius;
  double value(const Points<1>& x) const { return wall.value({x.position.col(0), x.low.col(0)}, radius); }
  Local<1> derivatives(const Points<1>& x) const { return wall.derivatives({x.position.col(0), x.low.col(0)}, radius); }
};

/// The forces of all faces along their normals.
inline Vec3 touch_force(const WallContact& wall, const ExactVector& x, double radius) {
  std::array<WallTouch, WallContact::most_faces> touch;
  Vec3 f = Vec3::Zero();
  for (int k = 0, n = wall.touches(x, radius, 0, touch); k < n; ++k) f += touch[k].force * touch[k].normal;
  return f;
}

/// A point of a wall that a sphere of radius ½ touches from the direction of the normal, and touches alone.
struct WallSite {
  std::string name;
  Region region;
  bool inside;
  Vec3 point, normal;
  double curved_radius = 0.5;                  // R_eff if curved
  bool curved_surface = false;                 // ∇²d is not zero
  bool radius_varies = false;                  // R_eff depends on x
};

inline Region frustum(Shape shape, int axis, double radius_lo, double radius_hi) {
  Region r;
  r.shape = shape, r.axis = axis, r.center = Vec3(0.25, -0.75, 0.5);
  r.axial_lo = -1.5, r.axial_hi = 3.0;
  r.radius = radius_lo, r.radius_lo = radius_lo, r.radius_hi = radius_hi;
  return r;
}

inline Region scaled(Region r, double s) {
  r.center *= s, r.lo *= s, r.hi *= s;
  r.axial_lo *= s, r.axial_hi *= s, r.radius *= s, r.radius_lo *= s, r.radius_hi *= s;
  return r;
}

inline std::vector<WallSite> wall_sites() {
  std::vector<WallSite> sites;
  const double r = 0.5;
  Region plane;
  plane.center = Vec3(1, -2, 0.5), plane.normal = Vec3(2, -1, 2) / 3;
  const Vec3 on_plane = plane.center + 3 * Vec3(1, 2, 0) - 2 * Vec3(0, 2, 1);
  sites.push_back({"plane, inside", plane, true, on_plane, plane.normal});
  sites.push_back({"plane, outside", plane, false, on_plane, -plane.normal});

  Region block;
  block.shape = Shape::block, block.lo = Vec3(-1, 0, 2), block.hi = Vec3(3, 4, 7);
  const Vec3 middle(1, 2.5, 4.5);
  for (int c = 0; c < 3; ++c)
    for (const bool high : {false, true}) {
      Vec3 p = middle;
      p[c] = high ? block.hi[c] : block.lo[c];
      const Vec3 n = high ? Vec3(Vec3::Unit(c)) : Vec3(-Vec3::Unit(c));
      sites.push_back({"block, inside", block, true, p, -n});
      sites.push_back({"block, outside", block, false, p, n});
      Region open = block;
      open.open[2 * c + !high] = true;
      sites.push_back({"block with an open face, outside another", open, true, p, n});
    }
  sites.push_back({"block, edge", block, false, Vec3(3, 0, 4.5), Vec3(0.6, -0.8, 0), r, true});
  sites.push_back({"block, corner", block, false, Vec3(-1, 4, 7), Vec3(-2, 1, 2) / 3, r, true});
  Region bottom = block;                       // only the face zlo is there
  bottom.open = {true, true, true, true, false, true};
  sites.push_back({"block's floor, from above its height", bottom, true, middle + Vec3(0, 0, -2.5), Vec3(0, 0, 1)});
  sites.push_back({"block's floor, from below", bottom, true, middle + Vec3(0, 0, -2.5), Vec3(0, 0, -1)});
  sites.push_back({"block's floor, its edge", bottom, true, Vec3(3, 2.5, 2), Vec3(0.6, 0, 0.8), r, true});

  Region ball;
  ball.shape = Shape::sphere, ball.center = Vec3(1, -2, 0.5), ball.radius = 2.5;
  const Vec3 e = Vec3(2, -1, 2) / 3;
  sites.push_back({"sphere, inside", ball, true, ball.center + 2.5 * e, -e, r * 2.5 / 2, true});
  sites.push_back({"sphere, outside", ball, false, ball.center + 2.5 * e, e, r * 2.5 / 3, true});

  for (int axis = 0; axis < 3; ++axis) {
    Vec3 z = Vec3::Unit(axis), out = Vec3::Zero();
    out[(axis + 1) % 3] = 0.6, out[(axis + 2) % 3] = -0.8;
    const auto at = [&](const Region& f, double rho, double height) -> Vec3 {
      return f.center + rho * out + (height - f.center[axis]) * z;
    };
    const Region tube = frustum(Shape::cylinder, axis, 2.5, 2.5);
    sites.push_back({"cylinder, inside", tube, true, at(tube, 2.5, 0.5), -out, r * 5 / 4.5, true});
    sites.push_back({"cylinder, lower cap inside", tube, true, at(tube, 1, -1.5), z});
    sites.push_back({"cylinder, upper cap inside", tube, true, at(tube, 1, 3), -z});
    sites.push_back({"cylinder, outside", tube, false, at(tube, 2.5, 0.5), out, r * 5 / 5.5, true});
    sites.push_back({"cylinder, lower cap outside", tube, false, at(tube, 1, -1.5), -z});
    sites.push_back({"cylinder, upper cap outside", tube, false, at(tube, 1, 3), z});
    sites.push_back({"cylinder, rim", tube, false, at(tube, 2.5, 3), 0.6 * out + 0.8 * z, r * 5 / 5.5, true});
    Region pipe = tube;
    pipe.open[0] = pipe.open[1] = true;
    sites.push_back({"open cylinder, inside", pipe, false, at(pipe, 2.5, 0.5), -out, r * 5 / 4.5, true});
    sites.push_back({"open cylinder, outside", pipe, true, at(pipe, 2.5, 0.5), out, r, true});
    sites.push_back({"open cylinder, rim", pipe, true, at(pipe, 2.5, 3), -0.6 * out + 0.8 * z, r, true});
    Region lids = tube;                        // only the caps
    lids.open[2] = true;
    sites.push_back({"caps, rim", lids, true, at(lids, 2.5, -1.5), 0.6 * out + 0.8 * z, r, true});
    Region endless = tube;
    endless.axial_lo = -std::numeric_limits<double>::infinity(), endless.axial_hi = -endless.axial_lo;
    sites.push_back({"endless cylinder, inside", endless, true, at(endless, 2.5, 100), -out, r * 5 / 4.5, true});
    sites.push_back({"endless cylinder, outside", endless, false, at(endless, 2.5, -100), out, r * 5 / 5.5, true});

    for (const bool narrowing : {true, false}) {          // slope 1.5 : 4.5
      const Region cone = narrowing ? frustum(Shape::cone, axis, 3, 1.5) : frustum(Shape::cone, axis, 1.5, 3);
      const double up = narrowing ? 1 : -1;
      const Vec3 n = (3 * out + up * z) / std::sqrt(10.0);
      const auto curved = [&](double R) { return r * 2 * R / (2 * R - r); };
      sites.push_back({"cone, inside", cone, true, at(cone, 2.25, 0.75), -n, curved(2.25), true, true});
      sites.push_back({"cone, outside", cone, false, at(cone, 2.25, 0.75), n, curved(2.25), true, true});
      sites.push_back({"cone, lower cap inside", cone, true, at(cone, 0.5, -1.5), z});
      sites.push_back({"cone, upper cap outside", cone, false, at(cone, 0.5, 3), z});
      const double lo = cone.radius_lo, hi = cone.radius_hi;
      sites.push_back({"cone, lower rim", cone, false, at(cone, lo, -1.5), 0.6 * out - 0.8 * z, curved(lo), true});
      sites.push_back({"cone, upper rim", cone, false, at(cone, hi, 3), 0.6 * out + 0.8 * z, curved(hi), true});
      Region funnel = cone;
      funnel.open[0] = funnel.open[1] = true;
      sites.push_back({"open cone, outside", funnel, true, at(funnel, 2.25, 0.75), n, curved(2.25), true, true});
      sites.push_back({"open cone, inside", funnel, false, at(funnel, 2.25, 0.75), -n, curved(2.25), true, true});
    }
  }
  return sites;
}

}  // namespace elamin
