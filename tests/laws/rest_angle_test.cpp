#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/cosine_angle.hpp"

using namespace elamin;

namespace {

// Sides of lengths 1.3 and 0.8 that turn by φ, in a plane that lies askew.
Points<3> turned(double turn, double size) {
  const Vec3 e1 = Vec3(1, 2, -0.5).normalized(), e2 = e1.cross(Vec3(0.3, -1, 2)).normalized();
  Eigen::Matrix3d x;
  x.col(1) = size * Vec3(0.2, -0.4, 0.1);
  x.col(0) = x.col(1) - 1.3 * size * e1;
  x.col(2) = x.col(1) + 0.8 * size * (std::cos(turn) * e1 + std::sin(turn) * e2);
  return Points<3>(x);
}

}  // namespace

TEST_CASE("angles with any rest angle agree with differences of their value", "[laws][angle]") {
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double rest : {0.3, 1.0, pi / 2, 2.5, 3.0, pi - 1e-3, pi})
      for (const double turn : {0.02, 0.3, pi / 2, 2.0, pi - 0.02}) {
        INFO("size " << size << ", rest " << rest << ", turn " << turn);
        const Points<3> x = turned(turn, size);
        const CosineAngle angle(0.7, rest);
        // It changes over its sides, and near the conical points over the distance from the straight line.
        const double length = 0.8 * size * std::min(1.0, std::min(turn, pi - turn));
        CHECK(check_law(angle, x, length) == std::vector<std::string>{});
        // U = B (1 − cos(θ − θ₀)) as it is printed
        const Vec3 u = x.edge(1, 0).hi.normalized(), w = x.edge(1, 2).hi.normalized();
        const double theta = std::atan2(u.cross(w).norm(), u.dot(w));
        CHECK(angle.value(x) == Approx(0.7 * (1 - std::cos(theta - rest))).epsilon(1e-14).margin(4e-16));
      }
}

TEST_CASE("near its rest angle an angle keeps its digits", "[laws][angle]") {
  // At rest in a right angle; u = (1, 0, 0) and w = (−s, 1, 0): sin(φ − φ₀) = (cos φ₀ + s sin φ₀)/√(1 + s²).
  const CosineAngle angle(3, pi / 2);
  for (const int power : {-3, -10, -25, -40}) {
    const double s = std::ldexp(1.0, power), length = std::sqrt(1 + s * s);
    Eigen::Matrix3d x;
    x << -1, 0, -s, 0, 0, 1, 0, 0, 0;
    const Local<3> u = angle.derivatives(Points<3>(x));
    const double sine = (std::cos(pi / 2) + s * std::sin(pi / 2)) / length;
    CHECK(u.value == Approx(3 * sine * sine / (1 + 1 / length)).epsilon(16 * epsilon));
    CHECK(u.gradient[6] == Approx(-3 * sine / (length * length)).epsilon(16 * epsilon));        // along −q = (−1, −s, 0)/|w|
  }
  // 1.2 rad, sides far from the origin: tails carry what positions alone would round away.
  Points<3> near = turned(pi - 1.2, 1), far = near;
  for (Eigen::Index k = 0; k < 9; ++k) {
    const Exact e = two_sum(1e6, near.position.data()[k]);
    far.position.data()[k] = e.hi, far.low.data()[k] = e.lo;
  }
  const CosineAngle other(3, 1.2);
  CHECK(other.value(near) <= 3 * 1e-31);
  CHECK(other.value(far) == Approx(other.value(near)).epsilon(1e-12).margin(0));
  const auto g = other.derivatives(near).gradient;
  CHECK((other.derivatives(far).gradient - g).norm() <= 1e-12 * g.norm());
}

TEST_CASE("straight at rest is the limit and is told by pi alone", "[laws][angle]") {
  std::mt19937 random(5);
  for (int k = 0; k < 20; ++k) {
    const Points<3> x = random_points<3>(random, 1);
    const Local<3> straight = CosineAngle{0.7}.derivatives(x), same = CosineAngle(0.7, pi).derivatives(x);
    CHECK(straight.value == same.value);
    CHECK(straight.gradient == same.gradient);
    CHECK(straight.hessian == same.hessian);
    const Local<3> nearly = CosineAngle(0.7, std::nextafter(pi, 0)).derivatives(x);
    CHECK(nearly.value == Approx(straight.value).epsilon(1e-14));
    CHECK((nearly.gradient - straight.gradient).norm() <= 1e-13 * straight.gradient.norm());
    CHECK((nearly.hessian - straight.hessian).norm() <= 1e-13 * straight.hessian.norm());
  }
}

TEST_CASE("in line an angle with another rest angle has no direction to turn in", "[laws][angle]") {
  const double rest = 2, B = 3;
  for (const bool folded : {false, true}) {
    Eigen::Matrix3d x = Eigen::Matrix3d::Zero();
    x(0, 0) = -1, x(0, 2) = folded ? -0.5 : 0.5;
    const CosineAngle angle(B, rest);
    const Local<3> u = angle.derivatives(Points<3>(x));
    CHECK(u.value == Approx(B * (1 - std::cos((folded ? 0 : pi) - rest))).epsilon(8 * epsilon));
    CHECK(u.value == angle.value(Points<3>(x)));
    CHECK(u.gradient.norm() == 0);
    CHECK(u.hessian.allFinite());
    CHECK(u.hessian == u.hessian.transpose());
    // Beside it the energy has the slope B sin φ₀ to every side.
    for (const double s : {1e-3, -1e-3, 1e-9}) {
      x(1, 2) = s;
      const double slope = (angle.value(Points<3>(x)) - u.value) / (2 * std::abs(s));      // φ = 2s on a side of ½
      CHECK(slope == Approx(-B * std::sin(pi - rest)).epsilon(std::max(4e-3, 1e-6)));
      CHECK(angle.derivatives(Points<3>(x)).hessian.allFinite());
    }
  }
  Eigen::Matrix3d meet = Eigen::Matrix3d::Zero();
  meet(0, 0) = 1;
  CHECK(CosineAngle(1, 2).derivatives(Points<3>(meet)).value == std::numeric_limits<double>::infinity());
  CHECK(CosineAngle(1, 2).derivatives(Points<3>(meet)).gradient.allFinite());
}

TEST_CASE("in a plane a turn has a sign, and a curved angle may be bent straight and beyond", "[laws][angle]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const int kept : {0, 1, 2})
    for (const double rest : {0.4, pi / 2, 2.7, pi - 1e-4})
      for (const double turn : {-3.0, -1.0, -1e-3, 0.0, 1e-3, 0.5, 2.9}) {
        INFO("kept " << kept << ", rest " << rest << ", turn " << turn);
        const double start = part(random);
        const int e = (kept + 1) % 3, f = (kept + 2) % 3;            // e × f is the axis
        Eigen::Matrix3d x = Eigen::Matrix3d::Zero();
        x(e, 0) = -1.3 * std::cos(start), x(f, 0) = -1.3 * std::sin(start);
        x(e, 2) = 0.8 * std::cos(start + turn), x(f, 2) = 0.8 * std::sin(start + turn);
        const CosineAngle angle(0.7, rest, kept);
        const Local<3> u = angle.derivatives(Points<3>(x));
        CHECK(u.value == Approx(0.7 * (1 - std::cos(turn - (pi - rest)))).epsilon(1e-14).margin(4e-16));
        CHECK(u.value == angle.value(Points<3>(x)));
        // The derivatives in the plane are those of the value, across a straight line too; none leads out of it.
        const double h = 1e-5;
        for (int a = 0; a < 9; ++a) {
          if (a % 3 == kept) {
            CHECK(u.gradient[a] == 0);
            CHECK(u.hessian.row(a).norm() == 0);
            continue;
          }
          Eigen::Matrix3d plus = x, minus = x;
          plus.data()[a] += h, minus.data()[a] -= h;
          const Local<3> up = angle.derivatives(Points<3>(plus)), down = angle.derivatives(Points<3>(minus));
          CHECK((up.value - down.value) / (2 * h) == Approx(u.gradient[a]).margin(1e-9));
          for (int b = 0; b < 9; ++b)
            if (b % 3 != kept) CHECK((up.gradient[b] - down.gradient[b]) / (2 * h) == Approx(u.hessian(b, a)).margin(1e-8));
        }
        // On the side of its rest it is the angle without a sign.
        if (turn > 0) {
          const Local<3> unsigned_angle = CosineAngle(0.7, rest).derivatives(Points<3>(x));
          CHECK(u.value == Approx(unsigned_angle.value).epsilon(1e-15));
          CHECK((u.gradient - unsigned_angle.gradient).norm() < 1e-14);
        }
      }
  // Straight at rest there is nothing to tell apart.
  const Points<3> x = random_points<3>(random, 1);
  CHECK(CosineAngle(0.7, pi, 2).derivatives(x).hessian == CosineAngle(0.7).derivatives(x).hessian);
}
