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
      double least = std::numeric_limits<double>::infinity();
      for (int c = 0; c < 3; ++c) least = std::min({least, offset(x[c], r.lo[c]).hi, -offset(x[c], r.hi[c]).hi});
      return least;
    }
    case Shape::cylinder:
    case Shape::cone: return Frustum(r).depth(axial_point(r, x));
  }
  return -1;
}

bool Region::contains(const ExactVector& x) const { return depth(*this, x) >= 0; }

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
