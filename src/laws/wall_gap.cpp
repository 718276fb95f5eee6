#include "laws/wall_gap.hpp"

#include "laws/frustum.hpp"

#include <optional>

namespace elamin {

namespace {

using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;

Vec4 by_x(const Vec3& g) { return {g[0], g[1], g[2], 0}; }

Varying constant(double value) { return {value, Vec4::Zero(), Mat4::Zero()}; }

/// R_eff = r m/(m + s r), s = ±1, of a wall with the radius of curvature m:
///   dR_eff/dm = s r²/(m + s r)²,   d²R_eff/dm² = −2 s r²/(m + s r)³
Varying curved_radius(double r, double s, const Varying& m) {
  const double sum = m.value + s * r;
  if (!(m.value > 0 && sum > 0)) return constant(s > 0 ? 0.0 : infinity);
  const double first = s * (r / sum) * (r / sum), second = -2 * first / sum;
  const Mat4 square = m.gradient * m.gradient.transpose();
  return {r * (m.value / sum), first * m.gradient, second * square + first * m.hessian};
}

class Search {
 public:
  Search(const Region& region, bool curved, const ExactVector& x, double r, double cutoff, WallGaps& found)
      : region_(region), curved_(curved), x_(x), r_(r), cutoff_(cutoff), found_(found) {}

  void plane(bool contained) {
    const ExactVector n{region_.normal, Vec3::Zero()};
    const Exact d = dot(x_ - ExactVector{region_.center, Vec3::Zero()}, n);
    flat(contained ? d : -d, contained ? region_.normal : -region_.normal);
  }

  void sphere(bool contained) {
    const ExactVector y = x_ - ExactVector{region_.center, Vec3::Zero()};
    const Exact rho = length(y), a = rho + (-region_.radius);
    if (!(rho.hi > 0)) return;
    const double side = contained ? -1 : 1;
    const Exact d = contained ? -a : a;
    if (!near(d)) return;
    const Vec3 e = y.hi / rho.hi;
    Varying distance{d.value(), side * by_x(e), Mat4::Zero()};
    distance.gradient[3] = -side;
    const Mat3 ee = e * e.transpose();
    distance.hessian.topLeftCorner<3, 3>() = side / rho.hi * (Mat3::Identity() - ee);
    Varying m = constant(region_.radius);
    m.gradient[3] = 1;
    add(d, distance, curved_ ? curved_radius(r_, side, m) : constant(r_));
  }

  void block_inside() {
    for (int c = 0; c < 3; ++c) {
      face_ = 2 * c;
      if (!region_.open[face_]) flat(offset(x_[c], region_.lo[c]), Vec3::Unit(c));
      face_ = 2 * c + 1;
      if (!region_.open[face_]) flat(-offset(x_[c], region_.hi[c]), -Vec3::Unit(c));
    }
  }

  void block_outside() {
    ExactVector nearest;                                  // from the nearest point of the closed faces to x
    Exact least{infinity, 0};
    int of_face = 0;
    for (int face = 0; face < 6; ++face) {
      if (region_.open[face]) continue;
      ExactVector y;
      for (int c = 0; c < 3; ++c) {
        const Exact above_lo = offset(x_[c], region_.lo[c]), above_hi = offset(x_[c], region_.hi[c]);
        if (face / 2 == c) y.set(c, face % 2 ? above_hi : above_lo);
        else if (above_lo.hi < 0) y.set(c, above_lo);
        else if (above_hi.hi > 0) y.set(c, above_hi);
      }
      const Exact d = y.hi.allFinite() ? length(y) : Exact{infinity, 0};
      if (d.hi < least.hi) least = d, nearest = y, of_face = face;
    }
    if (!near(least)) return;
    if (!(least.hi > 0)) return flat(least, (of_face % 2 ? 1.0 : -1.0) * Vec3::Unit(of_face / 2));
    const Vec3 n = nearest.hi / least.hi;
    Mat3 bend = -n * n.transpose();
    for (int c = 0; c < 3; ++c)
      if (nearest.hi[c] != 0) bend(c, c) += 1;
    if ((nearest.hi.array() != 0).count() == 1) bend.setZero();
    Varying distance{least.value(), by_x(n), Mat4::Zero()};
    distance.hessian.topLeftCorner<3, 3>() = bend / least.hi;
    add(least, distance, constant(r_));
  }

  void frustum_inside() {
    const Frustum f(region_);
    const AxialPoint p = axial_point(region_, x_);
    face_ = 2;
    if (!region_.open[face_])
      if (const auto foot = side(f, p, -1)) add(f, p, *foot, -1);
    face_ = 0;
    if (!region_.open[face_]) flat(p.above_lo, p.along);
    face_ = 1;
    if (!region_.open[face_]) flat(-p.above_hi, -p.along);
  }

  void frustum_outside() {
    const Frustum f(region_);
    const AxialPoint p = axial_point(region_, x_);
    std::optional<Foot> nearest;
    const auto offer = [&](const std::optional<Foot>& foot) {
      if (foot && (!nearest || (foot->distance - nearest->distance).hi < 0)) nearest = foot;
    };
    if (!region_.open[2]) offer(side(f, p, 1));
    if (!region_.open[0]) offer(cap(p, p.above_lo, f.radius_lo, -1));
    if (!region_.open[1]) offer(cap(p, p.above_hi, f.radius_hi, 1));
    if (nearest) add(f, p, *nearest, region_.shape == Shape::cone ? -1 : 1);
  }

 private:
  /// The nearest point of a face of a cylinder or cone, in the half-plane through the axis.
  struct Foot {
    Exact distance;
    double outward, along;                                // n_ρ, n_z
    bool on_side, rim;
    double fraction;                                      // of the way along the side from lo to hi
  };

  bool near(Exact distance) const { return std::isfinite(distance.hi) && r_ - distance.hi >= -cutoff_ - 4 * epsilon * r_; }

  void add(Exact distance, const Varying& d, const Varying& radius) {
    const double overlap = (Exact{r_, 0} - distance).value();
    if (overlap >= -cutoff_) found_.gap[found_.count++] = {overlap, d, radius, face_};
  }

  void flat(Exact distance, const Vec3& n) {
    if (near(distance)) add(distance, {distance.value(), by_x(n), Mat4::Zero()}, constant(r_));
  }

  static std::optional<Foot> circle(Exact a, Exact b, bool on_side, double fraction) {
    const Exact d = square_root(a * a + b * b);
    if (!(d.hi > 0)) return {};
    return Foot{d, a.hi / d.hi, b.hi / d.hi, on_side, true, fraction};
  }

  /// On the surface itself the sphere is on the side of this sign, as with `cap`.
  static std::optional<Foot> side(const Frustum& f, const AxialPoint& p, double on_surface) {
    if (!(p.rho.hi > 0)) return {};
    const Exact from_lo = p.rho + (-f.radius_lo), from_hi = p.rho + (-f.radius_hi), excess = f.excess(p);
    const double sign = excess.hi > 0 ? 1 : excess.hi < 0 ? -1 : on_surface;
    if (f.straight) {
      if (p.above_lo.hi < 0) return circle(from_lo, p.above_lo, true, 0);
      if (p.above_hi.hi > 0) return circle(from_hi, p.above_hi, true, 1);
      return Foot{sign > 0 ? excess : -excess, sign, 0, true, false, 0};
    }
    if (!(f.slant.hi > 0)) return {};
    const Exact t = (from_lo * f.rise + p.above_lo * f.height) / (f.slant * f.slant);
    if (t.hi <= 0) return circle(from_lo, p.above_lo, true, 0);
    if ((t + -1.0).hi >= 0) return circle(from_hi, p.above_hi, true, 1);
    const Exact d = excess / f.slant;
    const double cosine = f.height.hi / f.slant.hi, sine = f.rise.hi / f.slant.hi;
    return Foot{sign > 0 ? d : -d, sign * cosine, -sign * sine, true, false, t.value()};
  }

  /// The disc of this radius across the axis, b above it.
  static std::optional<Foot> cap(const AxialPoint& p, Exact b, double radius, double on_surface) {
    if (!std::isfinite(b.hi)) return {};
    const Exact a = p.rho + (-radius);
    if (a.hi > 0) return circle(a, b, false, 0);
    return Foot{b.hi > 0 ? b : -b, 0, b.hi > 0 ? 1.0 : b.hi < 0 ? -1.0 : on_surface, false, false, 0};
  }

  void add(const Frustum& f, const AxialPoint& p, const Foot& foot, double sign_of_curvature) {
    if (!near(foot.distance)) return;
    if (!foot.rim && !foot.on_side) return flat(foot.distance, foot.along * p.along);
    const double d = foot.distance.hi;
    Vec4 da = by_x(p.outward);
    da[3] = -1;                                           // ∇a, a = ρ − R
    const Vec4 dz = by_x(p.along);
    Mat4 daa = Mat4::Zero();                              // ∇²a
    const Mat3 zz = p.along * p.along.transpose(), oo = p.outward * p.outward.transpose();
    daa.topLeftCorner<3, 3>() = (Mat3::Identity() - zz - oo) / p.rho.hi;
    Varying distance{foot.distance.value(), foot.outward * da + foot.along * dz, foot.outward * daa};
    if (foot.rim) {
      const Vec4 across = foot.outward * dz - foot.along * da;
      const Mat4 square = across * across.transpose();
      distance.hessian += square / d;
    }
    const bool flat_outside = sign_of_curvature > 0 && (region_.any_open() || foot.outward <= 0);
    if (!curved_ || !foot.on_side || flat_outside) return add(foot.distance, distance, constant(r_));
    Varying m = constant(2 * f.radius_lo);                // 2 R_c,  R_c = R_lo + t ΔR,  t = (a ΔR + (z − lo) L)/S²
    m.gradient[3] = 2;
    if (foot.fraction > 0) m.value = foot.fraction < 1 ? 2 * (f.radius_lo + foot.fraction * f.rise.hi) : 2 * f.radius_hi;
    if (!foot.rim && !f.straight) {
      const double sine = f.rise.hi / f.slant.hi, cosine = f.height.hi / f.slant.hi;
      m.gradient += 2 * sine * (sine * da + cosine * dz);
      m.hessian = 2 * sine * sine * daa;
    }
    add(foot.distance, distance, curved_radius(r_, sign_of_curvature, m));
  }

  const Region& region_;
  bool curved_;
  const ExactVector& x_;
  double r_, cutoff_;
  WallGaps& found_;
  int face_ = 0;                                          // that is being looked at
};

}  // namespace

WallGaps wall_gaps(const Region& region, bool inside, bool curved, const ExactVector& x, double r, double cutoff) {
  WallGaps found;
  if (region.least_distance(x.hi) > r + cutoff) return found;
  const bool on_side = elamin::on_side(region, inside, x), contained = on_side ? inside : !inside;
  if (!on_side && !region.any_open()) return found;
  const ExactVector from_region = x - region.displacement;
  Search search(region, curved, from_region, r, cutoff, found);
  switch (region.shape) {
    case Shape::plane: search.plane(contained); break;
    case Shape::sphere: search.sphere(contained); break;
    case Shape::block: contained ? search.block_inside() : search.block_outside(); break;
    case Shape::cylinder:
    case Shape::cone: contained ? search.frustum_inside() : search.frustum_outside(); break;
  }
  return found;
}

}  // namespace elamin
