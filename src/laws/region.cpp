#include "laws/region.hpp"

#include "laws/frustum.hpp"

#include <algorithm>

namespace elamin {

double depth(const Region& r, const ExactVector& at) {
  const ExactVector x = at - r.displacement;
  const ExactVector from_center = x - ExactVector{r.center, Vec3::Zero()};
  switch (r.shape) {
    case Shape::plane: return dot(from_center, {r.normal, Vec3::Zero()}).hi;
    case Shape::sphere: return -(length(from_center) + (-r.radius)).hi;
    case Shape::block: {
      double least = infinity;
      for (int c = 0; c < 3; ++c) least = std::min({least, offset(x[c], r.lo[c]).hi, -offset(x[c], r.hi[c]).hi});
      return least;
    }
    case Shape::cylinder:
    case Shape::cone: return Frustum(r).depth(axial_point(r, x));
  }
  return -1;
}

bool Region::contains(const ExactVector& x) const { return depth(*this, x) >= 0; }

// Cylinders and cones in the half-plane of ρ and z: their side lies between both radii and between both ends, their caps are ρ ≤ radius at each end.
double Region::least_distance(const Vec3& at) const {
  constexpr double roundings = 16 * epsilon;
  double least = infinity;
  const Vec3 x = at - displacement.hi, y = x - center;
  if (shape == Shape::plane) {
    least = std::abs(normal.dot(y));
  } else if (shape == Shape::sphere) {
    least = std::abs(y.norm() - radius);
  } else if (shape == Shape::block) {
    const Vec3 beyond = (lo - x).cwiseMax(x - hi).cwiseMax(0);
    for (int face = 0; face < 6; ++face) {
      if (open[face]) continue;
      Vec3 apart = beyond;
      apart[face / 2] = x[face / 2] - (face % 2 ? hi : lo)[face / 2];
      least = std::min(least, apart.norm());
    }
  } else {
    const bool cone = shape == Shape::cone;
    const double first = cone ? radius_lo : radius, last = cone ? radius_hi : radius, z = x[axis];
    const double rho = Eigen::Vector2d(y[(axis + 1) % 3], y[(axis + 2) % 3]).norm(), beyond = std::max({axial_lo - z, z - axial_hi, 0.0});
    const auto offer = [&](double across, double along) { least = std::min(least, std::sqrt(across * across + along * along)); };
    if (!open[2]) offer(std::max({rho - std::max(first, last), std::min(first, last) - rho, 0.0}), beyond);
    if (!open[0]) offer(std::max(rho - first, 0.0), z - axial_lo);
    if (!open[1]) offer(std::max(rho - last, 0.0), z - axial_hi);
  }
  if (!std::isfinite(least)) return least;
  return least - roundings * (least + at.lpNorm<1>() + displacement.hi.lpNorm<1>() + center.lpNorm<1>());
}

Region Region::moved(const Vec3& d, double growth) const {
  Region r = *this;
  r.center += d, r.lo += d, r.hi += d;
  r.axial_lo += d[axis], r.axial_hi += d[axis];
  r.radius += growth, r.radius_lo += growth, r.radius_hi += growth;
  return r;
}

Region Region::moved_exactly(const ExactVector& d, double growth) const {
  Region r = moved(Vec3::Zero(), growth);
  r.displacement = displacement + d;
  return r;
}

Region Region::rounded() const {
  Region r = moved(displacement.hi, 0);
  r.displacement = {};
  return r;
}

}  // namespace elamin
