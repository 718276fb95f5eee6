#include "catch.hpp"
#include "laws/wall_sites.hpp"

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
