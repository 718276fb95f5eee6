#include "laws/region.hpp"

#include "laws/frustum.hpp"

namespace elamin {

bool Region::contains(const ExactVector& x) const {
  const ExactVector from_center = x - ExactVector{center, Vec3::Zero()};
  switch (shape) {
    case Shape::plane: return dot(from_center, {normal, Vec3::Zero()}).hi >= 0;
    case Shape::sphere: return (length(from_center) + (-radius)).hi <= 0;
    case Shape::block:
      for (int c = 0; c < 3; ++c)
        if (offset(x[c], lo[c]).hi < 0 || offset(x[c], hi[c]).hi > 0) return false;
      return true;
    case Shape::cylinder:
    case Shape::cone: return Frustum(*this).contains(axial_point(*this, x));
  }
  return false;
}

Region Region::moved(const Vec3& d, double growth) const {
  Region r = *this;
  r.center += d, r.lo += d, r.hi += d;
  r.axial_lo += d[axis], r.axial_hi += d[axis];
  r.radius += growth, r.radius_lo += growth, r.radius_hi += growth;
  return r;
}

}  // namespace elamin
