#include "model/geometry.hpp"

#include "catch.hpp"

#include <limits>

using namespace elamin;

namespace {

double off(Exact a, Exact b) { return std::abs((a - b).value()); }
Exact norm_of(const CosineSine& c) { return c.cosine * c.cosine + c.sine * c.sine; }

}  // namespace

TEST_CASE("Cosines and sines are good to 1e-31", "[model]") {
  const int n = GENERATE(3, 5, 7, 12, 158, 1001);
  // (cos + i sin)(2π/n) multiplied n times comes back to 1, and passes through the others on its way.
  const CosineSine step = cosine_sine(exact(1) / exact(n));
  CosineSine power{exact(1), exact(0)};
  double worst = 0;
  for (int k = 0; k <= n; ++k) {
    const CosineSine direct = cosine_sine(exact(k) / exact(n));
    worst = std::max(
        {worst, off(power.cosine, direct.cosine), off(power.sine, direct.sine), off(norm_of(direct), exact(1))});
    power = {power.cosine * step.cosine - power.sine * step.sine, power.cosine * step.sine + power.sine * step.cosine};
  }
  CHECK(worst < 1e-31 * (n + 10));
  CHECK(step.cosine.hi == Approx(std::cos(2 * exact_pi.hi / n)).epsilon(4 * epsilon));
  CHECK(step.sine.hi == Approx(std::sin(2 * exact_pi.hi / n)).epsilon(4 * epsilon));
}

TEST_CASE("Multiples of 30 degrees are taken as such", "[model]") {
  for (int k = -12; k <= 12; ++k) {
    const CosineSine c = cosine_sine(turns(k * 30 * exact_pi.hi / 180));
    const Exact half = exact(0.5), root = square_root(exact(3)) * half;
    const Exact expected[] = {exact(1),  root,  half,  exact(0), -half, -root,
                              exact(-1), -root, -half, exact(0), half,  root};
    CHECK(off(c.cosine, expected[(k + 12) % 12]) < 1e-31);
    CHECK(off(c.sine, expected[(k + 12 + 9) % 12]) < 1e-31);
    if (k % 3 == 0) CHECK((c.cosine.hi == std::round(c.cosine.hi) && c.cosine.lo == 0 && c.sine.lo == 0));
  }
  CHECK(off(turns(1e-3) * exact_pi * exact(2), exact(1e-3)) < 1e-33);
  CHECK(turns(0.5235).value() != 1.0 / 12);
  CHECK(std::abs(turns(std::numeric_limits<double>::max() / 180 * exact_pi.hi).value()) < 1);   // whole turns are none
}

TEST_CASE("The frame of a normal is the shortest rotation's", "[model]") {
  const Vec3 normal = GENERATE(Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, 0, -1e-300), Vec3(1, 0, 0), Vec3(0, -2, 0),
                               Vec3(1, 2, 3), Vec3(-1, 2, -3), Vec3(1e-9, -2e-9, -1), Vec3(1e-9, 1e-9, 1),
                               Vec3(1e-200, 1e-200, -1), Vec3(1e250, 1, -1e249));
  const Frame f = frame_of(normal);
  const Vec3 unit = scaled(normal).normalized();
  CHECK((f.n.hi - unit).norm() < 4 * epsilon);
  for (const auto& [a, b] : {std::pair(f.e1, f.e2), {f.e2, f.n}, {f.n, f.e1}}) {
    CHECK(std::abs(dot(a, b).value()) < 1e-30);
    CHECK(off(dot(a, a), exact(1)) < 1e-30);
  }
  CHECK((f.e1.hi.cross(f.e2.hi) - f.n.hi).norm() < 8 * epsilon);
  // Rodrigues' formula about z × n, by the cosine n_z; at n = −z about x.
  const Vec3 axis =
      normal.head<2>().isZero(0) ? Vec3(Vec3::UnitX()) : Vec3(scaled(Vec3(-normal[1], normal[0], 0)).normalized());
  const double angle = std::atan2(std::hypot(unit[0], unit[1]), unit[2]);
  const Eigen::AngleAxisd rotation(angle, axis);
  CHECK((rotation * Vec3::UnitX() - f.e1.hi).norm() < 8 * epsilon);
  CHECK((rotation * Vec3::UnitY() - f.e2.hi).norm() < 8 * epsilon);
}

TEST_CASE("Axes have frames without rounding", "[model]") {
  const Frame up = frame_of(Vec3(0, 0, 3)), down = frame_of(Vec3(0, 0, -3)), side = frame_of(Vec3(7, 0, 0));
  CHECK((up.e1.hi == Vec3(1, 0, 0) && up.e2.hi == Vec3(0, 1, 0)));
  CHECK((down.e1.hi == Vec3(1, 0, 0) && down.e2.hi == Vec3(0, -1, 0)));
  CHECK((side.e1.hi == Vec3(0, 0, -1) && side.e2.hi == Vec3(0, 1, 0)));
}
