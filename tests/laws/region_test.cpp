#include "catch.hpp"
#include "laws/wall_sites.hpp"

#include <random>

using namespace elamin;

TEST_CASE("a region contains what is inside of it and on its surface", "[laws][region]") {
  for (const WallSite& site : wall_sites()) {
    if (site.region.any_open()) continue;      // faces that are not there change nothing about what is inside
    INFO(site.name);
    CHECK(site.region.contains(Vec3(site.point + 1e-9 * site.normal)) == site.inside);
    CHECK(site.region.contains(Vec3(site.point - 1e-9 * site.normal)) == !site.inside);
    Region open = site.region;
    open.open[0] = true;
    CHECK(open.contains(Vec3(site.point + 1e-9 * site.normal)) == site.inside);
  }
  Region block;
  block.shape = Shape::block, block.lo = Vec3(-1, 0, 2), block.hi = Vec3(3, 4, 7);
  CHECK(block.contains(block.lo));
  CHECK(block.contains(block.hi));
  CHECK_FALSE(block.contains(Vec3(-1, 0, std::nextafter(2, 0))));
  // The tail of a position decides where it stands on the surface.
  CHECK(block.contains(ExactVector{block.lo, Vec3(1e-30, 0, 0)}));
  CHECK_FALSE(block.contains(ExactVector{block.lo, Vec3(-1e-30, 0, 0)}));
  const Region tube = frustum(Shape::cylinder, 2, 2.5, 2.5);
  CHECK(tube.contains(Vec3(tube.center + Vec3(1.5, 2, 2.5))));
  CHECK_FALSE(tube.contains(ExactVector{tube.center + Vec3(1.5, 2, 2.5), Vec3(1e-30, 0, 0)}));
  const Region cone = frustum(Shape::cone, 2, 3, 1.5);
  CHECK(cone.contains(Vec3(cone.center + 2.25 * Vec3(0, 1, 0) + Vec3(0, 0, 0.25))));
  CHECK_FALSE(cone.contains(Vec3(cone.center + 2.25 * Vec3(0, 1, 0) + Vec3(0, 0, 0.2500001))));
}

TEST_CASE("a region moves as a whole", "[laws][region]") {
  const Vec3 d(0.5, -0.25, 2);
  for (const WallSite& site : wall_sites()) {
    INFO(site.name);
    const WallContact here{site.region, site.inside, 1e4, true}, there{site.region.moved(d, 0), site.inside, 1e4, true};
    const ExactVector x{site.point + 0.375 * site.normal, Vec3::Zero()};
    CHECK(here.value(x, 0.5) > 0);
    CHECK(there.value(x + ExactVector{d, Vec3::Zero()}, 0.5) == Approx(here.value(x, 0.5)).epsilon(1e-13));
    CHECK(site.region.moved(d, 0).moved(-d, 0) == site.region);
  }
  const Region cone = frustum(Shape::cone, 0, 3, 1.5).moved(d, 0.125);
  CHECK(cone.radius_lo == 3.125);
  CHECK(cone.radius_hi == 1.625);
  CHECK(cone.axial_lo == -1.0);
  CHECK(cone.axial_hi == 3.5);
}

// What lets most particles be passed over: were it more than the distance, a wall would lose what touches it.
TEST_CASE("no face of a region is nearer than its least distance, which of all but cones is the distance", "[laws][region]") {
  constexpr double r = 0.5, anywhere = std::numeric_limits<double>::infinity();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-12, 12);
  for (const WallSite& site : wall_sites())
    for (int k = 0; k < 100; ++k) {
      const double scale = std::pow(10.0, place(random) / 4);
      const Vec3 moved(place(random), place(random), place(random)), x = site.point + Vec3(place(random), place(random), place(random)) / (1 + k % 5);
      const Region region = scaled(site.region, scale).moved_exactly({scale * moved, Vec3::Zero()}, 0);
      const WallContact wall{region, site.inside, 1e4, false};
      const Vec3 at = scale * (x + moved);
      std::array<WallTouch, WallContact::most_faces> touch;
      const int count = wall.touches({at, Vec3::Zero()}, scale * r, anywhere, touch);
      const double least = region.least_distance(at), size = scale * 100;
      for (int face = 0; face < count; ++face) CHECK(touch[face].gap + scale * r >= least);
      double nearest = anywhere;
      for (int face = 0; face < count; ++face) nearest = std::min(nearest, touch[face].gap + scale * r);
      INFO(site.name << ": " << nearest << ", " << least);
      if (count > 0 && region.shape != Shape::cone) CHECK(nearest - least <= 64 * epsilon * size);
    }
}
