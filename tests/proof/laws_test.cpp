// The laws in intervals against the laws.
#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/wall_contact.hpp"
#include "proof/laws.hpp"

using namespace elamin;

namespace {

using D = Interval<double>;

Vector3<D> box(const Vec3& d, double radius) {
  Vector3<D> all;
  for (int c = 0; c < 3; ++c) all[c] = D(d[c] - radius, d[c] + radius);
  return all;
}

// Entries in the intervals but for the rounding of the law's own.
template <class A, class B>
bool inside(const A& in, const B& x, double rounding) {
  for (int r = 0; r < x.rows(); ++r)
    for (int c = 0; c < x.cols(); ++c)
      if (!(in(r, c).lo - rounding <= x(r, c) && x(r, c) <= in(r, c).hi + rounding)) return false;
  return true;
}
template <class A>
double widest(const A& in) {
  double most = 0;
  for (int r = 0; r < in.rows(); ++r)
    for (int c = 0; c < in.cols(); ++c) most = std::max(most, in(r, c).hi - in(r, c).lo);
  return most;
}

struct Triple3 { Vec3 u, w; };

// Sides that are neither short nor in line, all in the plane of the kept coordinate, if there is one.
Triple3 sides(std::mt19937& random, int kept) {
  std::uniform_real_distribution<double> some(-1, 1);
  for (;;) {
    Triple3 t{Vec3::NullaryExpr([&] { return some(random); }), Vec3::NullaryExpr([&] { return some(random); })};
    if (kept >= 0) t.u[kept] = t.w[kept] = 0;
    if (t.u.norm() > 0.5 && t.w.norm() > 0.5 && t.u.cross(t.w).norm() > 0.2) return t;
  }
}

Points<3> points_of(const Triple3& t) {
  Eigen::Matrix3d x;
  x << Vec3::Zero(), t.u, t.u + t.w;
  return Points<3>(x);
}

}  // namespace

TEST_CASE("laws in intervals are the laws, and hold them in boxes", "[proof]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> some(-1, 1);
  const double rounding = 1e-13;                                   // of numbers of order one to ten in some fifty operations
  for (const double radius : {0.0, 1e-3})
    for (int k = 0; k < 300; ++k) {
      const auto moved = [&](Vec3 d, int kept = -1) {
        for (int c = 0; c < 3; ++c)
          if (c != kept) d[c] += radius * some(random);
        return d;
      };
      const Triple3 at = sides(random, -1);
      Eigen::Matrix<double, 3, 2> pair;
      pair << Vec3::Zero(), moved(at.u);
      const auto holds_pair = [&](const auto& in, const Local<2>& law) {
        CHECK(inside(in.gradient, law.gradient.tail<3>(), rounding));
        CHECK(inside(in.hessian, law.hessian.bottomRightCorner<3, 3>(), rounding));
        if (radius == 0) CHECK(widest(in.hessian) < rounding);
      };
      holds_pair(proof::derivatives<D>(proof::Bond{1.5, 0.8, 0}, box(at.u, radius), true),
                 HarmonicBond{1.5, 0.8}.derivatives(Points<2>(pair)));
      if (std::abs(at.u.norm() - 1) > 0.01)                        // nearer the force has a root in its Hessian
        holds_pair(proof::derivatives<D>(proof::Contact{2.0, 1.0}, box(at.u, radius), true),
                   HertzContact{2.0, 1.0}.derivatives(Points<2>(pair)));
      for (const auto& [rest, kept] : {std::pair(pi, -1), {2.5, -1}, {2.5, 1}, {pi, 2}}) {
        const Triple3 t = sides(random, kept), there{moved(t.u, kept), moved(t.w, kept)};
        const proof::Angle law{0.7, rest == pi ? 1.0 : std::cos(pi - rest), rest == pi ? 0.0 : std::sin(pi - rest), rest == pi ? -1 : kept};
        Vector3<D> u = box(t.u, radius), w = box(t.w, radius);
        if (kept >= 0) u[kept] = w[kept] = D(0);
        const auto in = proof::derivatives<D>(law, u, w, true);
        const Local<3> is = CosineAngle(0.7, rest, kept).derivatives(points_of(there));
        const std::vector<int> free = kept < 0 ? std::vector{0, 1, 2} : kept == 1 ? std::vector{0, 2} : std::vector{0, 1};
        const auto part = [&](const auto& m, int r, int c) {     // the coordinates of the plane
          Eigen::MatrixXd of(free.size(), free.size());
          for (std::size_t i = 0; i < free.size(); ++i)
            for (std::size_t j = 0; j < free.size(); ++j) of(i, j) = m(3 * r + free[i], 3 * c + free[j]);
          return of;
        };
        const auto part_in = [&](const Matrix3<D>& m) {
          Eigen::Matrix<D, Eigen::Dynamic, Eigen::Dynamic> of(free.size(), free.size());
          for (std::size_t i = 0; i < free.size(); ++i)
            for (std::size_t j = 0; j < free.size(); ++j) of(i, j) = m(free[i], free[j]);
          return of;
        };
        CHECK(inside(in.u, Vec3(-is.gradient.head<3>()), rounding));       // ∇₀ = −∂/∂u, ∇₂ = ∂/∂w
        CHECK(inside(in.w, Vec3(is.gradient.tail<3>()), rounding));
        CHECK(inside(part_in(in.uu), part(is.hessian, 0, 0), 10 * rounding));
        CHECK(inside(part_in(in.ww), part(is.hessian, 2, 2), 10 * rounding));
        CHECK(inside(part_in(in.uw), Eigen::MatrixXd(-part(is.hessian, 0, 2)), 10 * rounding));
        if (radius == 0) CHECK(widest(in.uu) < 100 * rounding);
      }
    }
}

TEST_CASE("walls in intervals are the walls, and hold them in boxes", "[proof]") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> some(-1, 1);
  const double rounding = 1e-13, r = 0.45;
  WallContact wall;
  wall.effective_modulus = 3, wall.region.normal = Vec3(0.6, 0, 0.8), wall.region.radius = 2;
  const double k = wall.effective_modulus * 4 / 3 * std::sqrt(r);
  for (const double radius : {0.0, 1e-3})
    for (int i = 0; i < 200; ++i) {
      const auto holds = [&](const auto& law, const Vec3& x) {
        const Vec3 at = x + Vec3::NullaryExpr([&] { return radius * some(random); });
        const Local<1> is = wall.derivatives({at, Vec3::Zero()}, r);
        const auto in = proof::derivatives<D>(law, box(x, radius), true);
        CHECK(inside(in.gradient, Vec3(is.gradient), rounding));
        CHECK(inside(in.hessian, Mat3(is.hessian), 10 * rounding));
        CHECK(is.gradient.norm() > 0.01);                          // it touches
        if (radius == 0) CHECK(widest(in.hessian) < 100 * rounding);
      };
      const double depth = 0.3 + 0.1 * some(random);               // of the centre above the surface
      wall.inside = true, wall.region.shape = Shape::plane;
      holds(proof::Plane{k, r, wall.region.normal, Vec3::Zero()}, wall.region.normal * depth);
      for (const bool in : {true, false})
        for (const int axis : {-1, 0, 1, 2}) {
          wall.inside = in, wall.region.shape = axis < 0 ? Shape::sphere : Shape::cylinder, wall.region.axis = std::max(axis, 0);
          Vec3 way = Vec3::NullaryExpr([&] { return some(random); });
          if (axis >= 0) way[axis] = 0;
          if (way.norm() < 0.1) continue;
          Vec3 x = way.normalized() * (in ? 2 - depth : 2 + depth);
          if (axis >= 0) x[axis] = 5 * some(random);
          holds(proof::Round{k, r, 2, Vec3::Zero(), axis, in}, x);
        }
    }
}

TEST_CASE("a contact that may be open or closed has the hull of both", "[proof]") {
  const auto in = proof::derivatives<D>(proof::Contact{2.0, 1.0}, Vector3<D>(D(0.99, 1.01), D(0), D(0)), true);
  CHECK(in.gradient[0].hi >= 0);
  CHECK(in.gradient[0].lo <= -2 * std::pow(0.01, 1.5));
  CHECK(in.hessian(0, 0).lo <= 0);
  CHECK(in.hessian(0, 0).hi >= 3 * std::sqrt(0.01));
  CHECK(in.hessian(0, 0).hi <= 3 * std::sqrt(0.01) * 1.05);        // n of the box is in [0.98, 1.02]
}
