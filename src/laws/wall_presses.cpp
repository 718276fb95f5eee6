// The faces that a sphere overlaps, in plain doubles: the same as wall_gaps finds, to rounding.
#include "laws/frustum.hpp"
#include "laws/wall_contact.hpp"
#include "laws/wall_gap.hpp"

namespace elamin {

namespace {

// As wall_gaps has it: r m/(m + s r) with m the wall's radius of curvature, s = −1 inside and 1 outside.
double curved_radius(double r, double m, double s) { return r * (m / (m + s * r)); }

class Presses {
 public:
  Presses(double r, std::array<WallPress, WallContact::most_faces>& out) : r_(r), out_(out) {}
  void add(double distance, const Vec3& normal, double effective_radius) {
    if (distance < r_) out_[count_++] = {r_ - distance, normal, effective_radius};
  }
  int count() const { return count_; }

 private:
  double r_;
  std::array<WallPress, WallContact::most_faces>& out_;
  int count_ = 0;
};

}  // namespace

int WallContact::presses(const Vec3& x, double r, std::array<WallPress, most_faces>& out) const {
  constexpr int left = -1;
  if (!(effective_modulus > 0)) return 0;
  Presses found(r, out);
  const double side = inside ? -1 : 1;
  if (region.shape == Shape::plane) {
    const double d = -side * region.normal.dot(x - region.center);
    if (!(d >= 0)) return left;
    found.add(d, -side * region.normal, r);
    return found.count();
  }
  if (region.shape == Shape::block && inside && !region.any_open()) {
    for (int c = 0; c < 3; ++c)
      if (!(x[c] >= region.lo[c] && x[c] <= region.hi[c])) return left;
    for (int c = 0; c < 3; ++c) {
      found.add(x[c] - region.lo[c], Vec3::Unit(c), r);
      found.add(region.hi[c] - x[c], -Vec3::Unit(c), r);
    }
    return found.count();
  }
  const bool endless = std::isinf(region.axial_lo) && std::isinf(region.axial_hi);
  const bool round = region.shape == Shape::sphere || (region.shape == Shape::cylinder && endless && !region.any_open());
  if (round) {
    Vec3 y = x - region.center;
    if (region.shape == Shape::cylinder) y[region.axis] = 0;
    const double rho = y.norm(), d = side * (rho - region.radius);
    const double m = region.shape == Shape::sphere ? region.radius : 2 * region.radius;
    if (!(d >= 0)) return left;
    if (!(rho > 0) || (curved && !(m + side * r > 0))) return 0;
    found.add(d, side / rho * y, curved ? curved_radius(r, m, side) : r);
    return found.count();
  }
  if (!region.any_open() && !on_side(region, inside, {x, Vec3::Zero()})) return left;
  std::array<WallTouch, most_faces> all;
  const int n = touches({x, Vec3::Zero()}, r, 0, all);
  for (int k = 0; k < n; ++k)
    if (std::isfinite(all[k].effective_radius)) found.add(all[k].gap + r, all[k].normal, all[k].effective_radius);
  return found.count();
}

Vec3 WallContact::curving_force(const Vec3& x, double r) const {
  Vec3 f = Vec3::Zero();
  if (!curved || region.shape != Shape::cone || !(effective_modulus > 0)) return f;
  for (const WallGap& g : wall_gaps(region, inside, curved, {x, Vec3::Zero()}, r, 0)) {
    if (!(g.overlap > 0) || !std::isfinite(g.radius.value)) continue;
    const double k = effective_modulus * 4 / 3 * std::sqrt(g.radius.value);
    f -= 0.2 * k * g.overlap * g.overlap * std::sqrt(g.overlap) / g.radius.value * g.radius.gradient.head<3>();   // U/2R ∇R
  }
  return f;
}

}  // namespace elamin
