// The laws in plain arithmetic, as dynamics takes them, against their exact derivatives.
#include "catch.hpp"
#include "dynamics/lanes.hpp"
#include "laws/cohesion.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "laws/hertz_contact.hpp"
#include "laws/wall_contact.hpp"

#include <random>

using namespace elamin;

namespace {

template <int n>
Points<n> some_points(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Points<n>(Eigen::Matrix<double, 3, n>::NullaryExpr([&] { return uniform(random); }));
}

template <class T> Triple<T> triple(const Vec3& v) { return {T(v[0]), T(v[1]), T(v[2])}; }
Vec3 vector(const Triple<double>& t) { return {t.x, t.y, t.z}; }
Vec3 vector(const Triple<Lanes>& t) { return {t.x[2], t.y[2], t.z[2]}; }
double number(double x) { return x; }
double number(Lanes x) { return x[1]; }

template <class T>
void agree() {
  using std::sqrt;
  std::mt19937 random(11);
  for (int k = 0; k < 100; ++k) {
    const Points<2> pair = some_points<2>(random);
    const Vec3 d = pair.edge(0, 1).hi;
    const double r = d.norm();
    const HarmonicBond bond{3, 0.8};
    CHECK((number(HarmonicBond::pull(T(r), T(3.0), T(0.8))) / r * d - bond.derivatives(pair).force_part(1)).norm() <= 1e-13 * 6);
    const HertzContact contact{5, r + 0.1 * (k % 7 + 1)};
    const double push = number(HertzContact::push(T(contact.contact_distance - r), T(5.0)));
    CHECK((-push / r * d - contact.derivatives(pair).force_part(1)).norm() <= 1e-13 * 5 * contact.contact_distance * std::sqrt(contact.contact_distance));
    const Cohesion cohesion{2, 0.9 * r, 3 * r};
    const Vec3 exact = cohesion.derivatives(pair).force_part(1);
    CHECK((-number(Cohesion::push(T(r * r), T(2.0), T(0.9 * r))) * d - exact).norm() <= 1e-13 * 100 * 2 / r);

    const Points<3> triple_points = some_points<3>(random);
    const Vec3 u = triple_points.edge(0, 1).hi, w = triple_points.edge(1, 2).hi;
    const Triple<T> a = triple<T>(u.normalized()), b = triple<T>(w.normalized());
    Local<3> angle = CosineAngle{4}.derivatives(triple_points);
    CHECK((4 / u.norm() * vector(CosineAngle::across(a, b)) - angle.force_part(0)).norm() <= 1e-13 * 4 / u.norm());
    CHECK((-4 / w.norm() * vector(CosineAngle::across(b, a)) - angle.force_part(2)).norm() <= 1e-13 * 4 / w.norm());
  }
}

}  // namespace

TEST_CASE("laws in plain doubles agree with their derivatives", "[laws]") { agree<double>(); }
TEST_CASE("laws in four doubles at a time agree with their derivatives", "[laws]") { agree<Lanes>(); }

TEST_CASE("walls in plain doubles agree with their derivatives", "[laws]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::array<WallPress, WallContact::most_faces> presses;
  int touched = 0, left = 0;
  for (const Shape shape : {Shape::plane, Shape::block, Shape::sphere, Shape::cylinder, Shape::cone})
    for (int kind = 0; kind < 16; ++kind) {
      WallContact wall;
      wall.region.shape = shape, wall.inside = kind & 1, wall.curved = kind & 2, wall.effective_modulus = 30;
      wall.region.normal = Vec3(2, 1, -2) / 3, wall.region.lo = Vec3::Constant(-1), wall.region.hi = Vec3(1.1, 1.2, 1.3);
      wall.region.radius = 1.2, wall.region.radius_lo = 0.9, wall.region.radius_hi = 1.4;
      if (kind & 4) wall.region.axial_lo = -1, wall.region.axial_hi = 1.1;
      if (kind & 8 && shape != Shape::plane && shape != Shape::sphere) wall.region.open[0] = true;
      for (int k = 0; k < 200; ++k) {
        const Vec3 x(uniform(random), uniform(random), uniform(random));
        const double r = 0.4;
        const int count = wall.presses(x, r, presses);
        Vec3 f = wall.curving_force(x, r);
        for (int face = 0; face < count; ++face)
          f += HertzContact::push(presses[face].overlap, 40 * std::sqrt(presses[face].effective_radius)) * presses[face].normal;
        INFO(static_cast<int>(shape) << ' ' << kind << ' ' << x.transpose());
        const Vec3 exact = -wall.derivatives({x, Vec3::Zero()}, r).gradient;
        CHECK((f - exact).norm() <= 1e-13 * std::max(30 * r * r, exact.norm()));
        touched += count > 0, left += count < 0;
      }
    }
  CHECK(touched > 1000);
  CHECK(left > 1000);
}
