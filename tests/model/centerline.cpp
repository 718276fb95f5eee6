#include "model/centerline.hpp"

#include "catch.hpp"
#include "laws/section.hpp"
#include "model/geometry.hpp"

using namespace elamin;

namespace {

double size(const ExactVector& v) { return (v.hi + v.lo).norm(); }

/// The largest difference of a distance between neighbours from the first one.
double uneven(const Centerline& line) {
  const Exact first = distance(line.centers[0], line.centers[1]);
  double most = 0;
  for (std::size_t i = 1; i + 1 < line.centers.size(); ++i)
    most = std::max(most, std::abs((distance(line.centers[i], line.centers[i + 1]) - first).value()));
  return most;
}

/// The centre of a circle through three points, in the plane z = 0, to rounding.
Vec3 centre_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  Eigen::Matrix2d m;
  m.row(0) = (b - a).head<2>(), m.row(1) = (c - a).head<2>();
  const Eigen::Vector2d x = m.inverse() * Eigen::Vector2d((b - a).squaredNorm() / 2, (c - a).squaredNorm() / 2);
  return a + Vec3(x[0], x[1], 0);
}

}  // namespace

TEST_CASE("A row goes on beyond its clamped ends", "[model]") {
  const ExactVector from = exact(Vec3(0.1, -0.2, 0.3)), to = exact(Vec3(1.3, 0.7, -0.1));
  const double length = distance(from, to).value();
  for (const auto& [clamped, bonds] : {std::pair(Clamped{false, false}, 9), {Clamped{true, false}, 8},
                                       {Clamped{false, true}, 8}, {Clamped{true, true}, 7}}) {
    const Centerline line = row(from, to, 10, clamped);
    REQUIRE(line.centers.size() == 10);
    CHECK(line.spacing == Approx(length / bonds).epsilon(4 * epsilon));
    CHECK(uneven(line) < 1e-30);
    CHECK((line.centers[clamped.from].hi - from.hi).norm() < 4 * epsilon);
    CHECK((line.centers[9 - clamped.to].hi - to.hi).norm() < 4 * epsilon);
  }
}

TEST_CASE("A polyline has a particle on every corner, evenly to 1e-30", "[model]") {
  const double s = GENERATE(1e-3, 1.0, 1e3);
  const std::vector<Vec3> corners{s * Vec3(0, 0, 0), s * Vec3(0, 3, 0), s * Vec3(4, 3, 0), s * Vec3(4, 3, 2)};   // 3, 4, 2
  const auto line = polyline(corners, 19);
  REQUIRE(line);
  CHECK(line->spacing == Approx(s / 2).epsilon(4 * epsilon));
  CHECK(uneven(*line) < 1e-30 * s);
  for (const auto& [i, corner] : {std::pair(0, 0), {6, 1}, {14, 2}, {18, 3}}) CHECK(line->centers[i].hi == corners[corner]);
  CHECK(line->centers[3].hi.isApprox(s * Vec3(0, 1.5, 0), 1e-15));
  CHECK_FALSE(polyline(corners, 18));
  CHECK_FALSE(polyline(corners, 2));
  CHECK(fitting(corners, 18) == std::array{10, 19});
  CHECK(fitting(corners, 5) == std::array{0, 10});
  const auto clamped = polyline(corners, 11, {true, false});
  REQUIRE(clamped);
  CHECK(clamped->spacing == Approx(s).epsilon(4 * epsilon));
  CHECK(clamped->centers[0].hi.isApprox(s * Vec3(0, -1, 0), 1e-15));
  CHECK(clamped->centers[4].hi == corners[1]);
  CHECK(clamped->centers[10].hi == corners[3]);
  // Lengths without a common measure: no number of particles is even.
  CHECK(fitting({{0, 0, 0}, {1, 0, 0}, {1, std::sqrt(2.0), 0}}, 50) == std::array{0, 0});
}

TEST_CASE("An arc is a piece of a regular polygon", "[model]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3), degrees = GENERATE(1.0, 90.0, 180.0, 215.0, 350.0);
  const int n = GENERATE(3, 4, 51);
  const Arch arch{scale * Vec3(-0.3, 0.4, 0), scale * Vec3(0.9, 0.1, 0), Vec3(1, 7, 0)};
  const double chord = (arch.to - arch.from).norm(), half = degrees / 360 * pi, radius = chord / (2 * std::sin(half));
  const Centerline line = arc(arch, exact(degrees) / exact(360), n);
  REQUIRE(line.centers.size() == static_cast<std::size_t>(n));
  CHECK(line.centers[0].hi == arch.from);
  CHECK(line.centers[n - 1].hi == arch.to);
  CHECK(line.spacing == Approx(2 * radius * std::sin(half / (n - 1))).epsilon(1e-14));
  CHECK(std::abs(line.spacing - distance(line.centers[0], line.centers[1]).value()) < 4 * epsilon * line.spacing);
  CHECK(uneven(line) < 1e-28 * radius);
  const Vec3 along = (arch.to - arch.from) / chord, across = Vec3(-along[1], along[0], 0);
  const Vec3 centre = (arch.from + arch.to) / 2 - radius * std::cos(half) * across;
  for (const ExactVector& x : line.centers) {
    CHECK((x.hi - centre).norm() == Approx(radius).epsilon(1e-13));
    CHECK(x.hi[2] == 0);
  }
  CHECK((centre_of(line.centers[0].hi, line.centers[1].hi, line.centers[n - 1].hi) - centre).norm() < 1e-9 * radius);
  if (n % 2)                                       // it rises to the side of `toward`
    CHECK((line.centers[n / 2].hi - centre - radius * across).norm() < 1e-13 * radius);
  // Clamped it goes on around the same circle.
  const Centerline more = arc(arch, exact(degrees) / exact(360), n + 2, {true, true});
  CHECK(uneven(more) < 1e-28 * radius);
  CHECK(more.spacing == line.spacing);
  for (const int end : {0, n + 1}) CHECK((more.centers[end].hi - centre).norm() == Approx(radius).epsilon(1e-13));
  for (int i = 0; i < n; ++i) CHECK((more.centers[i + 1].hi - line.centers[i].hi).norm() < 1e-15 * radius);
}

TEST_CASE("The turns of a rise", "[model]") {
  for (const double degrees : {0.01, 1.0, 90.0, 180.0, 300.0}) {
    const auto [c, s] = cosine_sine(exact(degrees) / exact(720));              // of α/2
    const double chord = 2 * s.value(), rise = 1 - c.value();                  // R = 1
    CHECK(turns_of_rise(chord, rise).value() == Approx(degrees / 360).epsilon(degrees < 1 ? 1e-6 : 1e-10));
    // tan(α/4) = 2h/c to about 30 digits
    const auto quarter = cosine_sine(turns_of_rise(chord, rise) * exact(0.25));
    CHECK(std::abs((quarter.sine / quarter.cosine * exact(chord) / exact(2) - exact(rise)).value()) < 1e-29 * chord);
  }
  CHECK(std::abs((turns_of_rise(2, 1) - exact(0.5)).value()) < 1e-30);
}

TEST_CASE("Half a sine wave in equal chords", "[model]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3), relative = GENERATE(1e-4, 0.1, -1.0, 3.0);
  const int n = GENERATE(3, 4, 10, 201);
  const double chord = 5 * scale, rise = relative * chord;
  const Arch arch{scale * Vec3(1, 2, 3), scale * Vec3(1, 5, 7), Vec3(scale, 0, 0)};
  const auto line = half_sine(arch, rise, n);
  if (!line) {
    CHECK((n == 4 && relative == 3));              // of three chords none is equal to the others without going back
    return;
  }
  REQUIRE(line->centers.size() == static_cast<std::size_t>(n));
  CHECK(line->centers[0].hi == arch.from);
  CHECK(line->centers[n - 1].hi == arch.to);
  const double length = chord + std::abs(rise);
  CHECK(uneven(*line) < 1e-28 * length);
  CHECK(std::abs(line->spacing - distance(line->centers[0], line->centers[1]).value()) < 4 * epsilon * line->spacing);
  for (const ExactVector& x : line->centers) {
    const double along = (x.hi - arch.from).dot(Vec3(0, 0.6, 0.8));
    CHECK(std::abs(x.hi[0] - arch.from[0] - rise * std::sin(pi * along / chord)) < 1e-14 * length);
  }
  for (int i = 0; i < n; ++i) {                    // the halves are alike
    const ExactVector a = line->centers[i] - exact(arch.from), b = exact(arch.to) - line->centers[n - 1 - i];
    CHECK(std::abs(a.hi.norm() - b.hi.norm()) < 1e-14 * length);
    CHECK(size(a) >= 0);
  }
}

TEST_CASE("Along a curve particles are evenly by its length, on its points or not", "[model]") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0.5}};       // 2.5 long
  const Centerline line = along_curve(points, 6);
  REQUIRE(line.centers.size() == 6);
  CHECK(line.spacing == 0.5);
  const std::vector<Vec3> expected{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 0.5, 0}, {1, 1, 0}, {1, 1, 0.5}};
  for (int i = 0; i < 6; ++i) CHECK(line.centers[i].hi == expected[i]);
  // Over a corner without a particle a bond is shorter; beyond the ends the curve goes on straight.
  const Centerline bent = along_curve({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 6, {true, true});
  CHECK(bent.spacing == Approx(2.0 / 3).epsilon(1e-15));
  CHECK((bent.centers[0].hi - Vec3(-2.0 / 3, 0, 0)).norm() < 1e-15);
  CHECK((bent.centers[5].hi - Vec3(1, 5.0 / 3, 0)).norm() < 1e-15);
  CHECK(distance(bent.centers[2], bent.centers[3]).value() == Approx(std::sqrt(2.0) / 3).epsilon(1e-15));
  // A helix of many points: arc length R√(φ² + …), every bond as long as every other to what the points allow.
  std::vector<Vec3> helix;
  for (int k = 0; k <= 3000; ++k) helix.push_back({std::cos(2 * pi * k / 1000), std::sin(2 * pi * k / 1000), 0.3 * k / 1000});
  const Centerline spring = along_curve(helix, 101);
  CHECK(spring.spacing == Approx(3 * std::hypot(2 * pi, 0.3) / 100).epsilon(2e-6));   // the polygon is shorter by (2π/1000)²/24
  CHECK(uneven(spring) < 2e-6 * spring.spacing);
}
