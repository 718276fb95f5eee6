#include "laws/wall_contact.hpp"

#include "laws/wall_gap.hpp"

namespace elamin {

namespace {

/// k = 4/3 E √R_eff.
double stiffness(double modulus, const WallGap& g) { return modulus * 4 / 3 * std::sqrt(g.radius.value); }

/// k δ^{3/2}.
double contact_force(double modulus, const WallGap& g) {
  return g.overlap > 0 && modulus > 0 ? stiffness(modulus, g) * g.overlap * std::sqrt(g.overlap) : 0.0;
}

/// 2/5 k δ^{5/2}.
double energy(double modulus, const WallGap& g) { return g.overlap > 0 ? 0.4 * contact_force(modulus, g) * g.overlap : 0.0; }

/// U(x, R) of all faces; the coordinates are x, y, z, R.
Varying energy(const WallContact& wall, const ExactVector& x, double r) {
  Varying U{0, Eigen::Vector4d::Zero(), Eigen::Matrix4d::Zero()};
  if (!(wall.effective_modulus > 0)) return U;
  for (const WallGap& g : wall_gaps(wall.region, wall.inside, wall.curved, x, r, 0)) {
    const double u = energy(wall.effective_modulus, g);
    U.value += u;
    if (!(u > 0) || !std::isfinite(U.value)) continue;
    const double force = contact_force(wall.effective_modulus, g), radius = g.radius.value;
    const Eigen::Vector4d &n = g.distance.gradient, &s = g.radius.gradient;
    U.gradient += -force * n + u / (2 * radius) * s;
    const Eigen::Matrix4d nn = n * n.transpose();
    U.hessian += 1.5 * force / g.overlap * nn - force * g.distance.hessian;
    if (s == Eigen::Vector4d::Zero()) continue;
    const Eigen::Matrix4d ss = s * s.transpose(), ns = n * s.transpose();
    U.hessian += u / (2 * radius) * g.radius.hessian - u / (4 * radius * radius) * ss;
    U.hessian -= force / (2 * radius) * (ns + ns.transpose());
  }
  if (!std::isfinite(U.value)) U.gradient.setZero(), U.hessian.setZero();
  return U;
}

}  // namespace

double WallContact::value(const ExactVector& x, double r) const {
  if (!(effective_modulus > 0)) return 0;
  double U = 0;
  for (const WallGap& g : wall_gaps(region, inside, curved, x, r, 0)) U += energy(effective_modulus, g);
  return U;
}

Local<1> WallContact::derivatives(const ExactVector& x, double r) const {
  const Varying U = energy(*this, x, r);
  Local<1> u;
  u.value = U.value;
  u.gradient = U.gradient.head<3>();
  u.hessian = U.hessian.topLeftCorner<3, 3>();
  return u;
}

Vec3 WallContact::radius_rate(const ExactVector& x, double r) const {
  return energy(*this, x, r).hessian.topRightCorner<3, 1>();
}

int WallContact::touches(const ExactVector& x, double r, double cutoff, std::array<WallTouch, most_faces>& out) const {
  static_assert(most_faces == WallGaps::most);
  int count = 0;
  for (const WallGap& g : wall_gaps(region, inside, curved, x, r, cutoff)) {
    WallTouch& touch = out[count++];
    touch.gap = -g.overlap;
    touch.normal = g.distance.gradient.head<3>();
    touch.point = x.hi - g.distance.value * touch.normal;
    touch.effective_radius = g.radius.value;
    touch.force = contact_force(effective_modulus, g);
    touch.face = g.face;
  }
  return count;
}

}  // namespace elamin
