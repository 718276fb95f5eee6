#include "laws/rounded/wall.hpp"

#include "laws/wall_gap.hpp"

namespace elamin {

namespace {

/// One vertex near one face of the wall.
struct NearFace {
  int vertex, face;
  Vec3 arm;
  double distance, gap;
  Vec3 normal;
  Mat3 curvature;
};

template <class OnNear>
void visit(const RoundedWall& wall, const RoundedBody& body, const OnNear& near) {
  const double rho = body.shape->radius, cutoff = wall.kernel.cutoff;
  const Mat3 R = body.pose.rotation.toRotationMatrix();
  for (int k = 0; k < static_cast<int>(body.shape->vertices.size()); ++k) {
    const Vec3 arm = R * body.shape->vertices[k];
    const ExactVector x = body.pose.position + ExactVector{arm, Vec3::Zero()};
    if (wall.region.shape == Shape::plane) {
      const Vec3 n = wall.inside ? wall.region.normal : Vec3(-wall.region.normal);
      const double s = dot(x - wall.region.displacement - ExactVector{wall.region.center, Vec3::Zero()}, ExactVector{n, Vec3::Zero()}).value();
      if (s - rho <= cutoff) near(NearFace{k, 0, arm, s, s - rho, n, Mat3::Zero()});
      continue;
    }
    for (const WallGap& g : wall_gaps(wall.region, wall.inside, false, x, rho, cutoff))
      near(NearFace{k, g.face, arm, g.distance.value, -g.overlap, g.distance.gradient.head<3>(), g.distance.hessian.topLeftCorner<3, 3>()});
  }
}

}  // namespace

double RoundedWall::value(const RoundedBody& body) const {
  double U = 0;
  visit(*this, body, [&](const NearFace& v) { U += kernel.value(v.gap); });
  return U;
}

Local<2> RoundedWall::derivatives(const RoundedBody& body) const {
  Local<2> u;
  visit(*this, body, [&](const NearFace& v) {
    u.value += kernel.value(v.gap);
    const double slope = kernel.slope(v.gap);
    add_point(u, v.arm, slope * v.normal, kernel.curvature(v.gap) * v.normal * v.normal.transpose() + slope * v.curvature);
  });
  mirror(u);
  return u;
}

void RoundedWall::touches(const RoundedBody& body, std::vector<RoundedWallTouch>& out) const {
  visit(*this, body, [&](const NearFace& v) {
    const Vec3 point = body.pose.position.hi + v.arm - v.distance * v.normal;
    out.push_back({v.vertex, v.gap, v.normal, point, -kernel.slope(v.gap), v.face});
  });
}

}  // namespace elamin
