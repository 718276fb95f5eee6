#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/frustum.hpp"
#include "laws/wall_sites.hpp"

using namespace elamin;

namespace {

constexpr double ball_radius = 0.5;                     // of the sphere

// Leaves the curvature of the wall out of the Hessian.
struct WithoutBend : AtWall {
  Local<1> derivatives(const Points<1>& x) const {
    Local<1> u = AtWall::derivatives(x);
    u.hessian = u.gradient * u.gradient.transpose() * (u.hessian.trace() / u.gradient.squaredNorm());
    return u;
  }
};

// Takes R_eff for constant: LAMMPS's force at a cone.
struct FixedRadius : AtWall {
  Local<1> derivatives(const Points<1>& x) const {
    Local<1> u = AtWall::derivatives(x);
    u.gradient = -touch_force(wall, {x.position.col(0), x.low.col(0)}, radius);
    return u;
  }
};

}  // namespace

TEST_CASE("walls of every shape agree with differences of their energy", "[laws][wall]") {
  for (const WallSite& site : wall_sites())
    for (const double scale : {std::ldexp(1.0, -10), 1.0, std::ldexp(1.0, 10)})
      for (const bool curved : {false, true})
        for (const double overlap : {1e-6, 1e-3, 0.1, 0.4}) {
          INFO(site.name << ", scale " << scale << (curved ? ", curved" : "") << ", overlap " << overlap);
          const double delta = overlap * ball_radius * scale;
          const AtWall law{{scaled(site.region, scale), site.inside, 1e4, curved}, ball_radius * scale};
          const Vec3 x = scale * site.point + (ball_radius * scale - delta) * site.normal;
          CHECK(check_law(law, Points<1>(x), delta) == std::vector<std::string>{});

          std::array<WallTouch, WallContact::most_faces> touch;
          const ExactVector centre{x, Vec3::Zero()};
          const int count = law.wall.touches(centre, law.radius, 0, touch);
          REQUIRE(count == 1);
          const double expected = scale * (curved ? site.curved_radius : ball_radius);
          CHECK(touch[0].gap == Approx(-delta).epsilon(1e-9));
          CHECK((touch[0].normal - site.normal).norm() <= 1e-14);
          CHECK((touch[0].point - scale * site.point).norm() <= 1e-13 * scale);
          CHECK(touch[0].effective_radius == Approx(expected).epsilon(1e-13));
          const double force = 4.0 / 3 * 1e4 * std::sqrt(expected) * std::pow(-touch[0].gap, 1.5);
          CHECK(touch[0].force == Approx(force).epsilon(1e-13));
          CHECK(law.wall.value(centre, law.radius) == Approx(0.4 * touch[0].force * -touch[0].gap).epsilon(8 * epsilon));
        }
}

TEST_CASE("the radius of a wall acts as a fourth coordinate", "[laws][wall]") {
  for (const WallSite& site : wall_sites())
    for (const bool curved : {false, true})
      for (const double overlap : {1e-6, 0.1}) {
        INFO(site.name << (curved ? ", curved" : "") << ", overlap " << overlap);
        const double delta = overlap * ball_radius;
        const ExactVector x{site.point + (ball_radius - delta) * site.normal, Vec3::Zero()};
        const WallContact wall{site.region, site.inside, 1e4, curved};
        const auto gradient = [&](double growth) -> Vec3 {
          const WallContact grown{site.region.moved(Vec3::Zero(), growth), site.inside, 1e4, curved};
          return grown.derivatives(x, ball_radius).gradient;
        };
        // A power of two: the radii of the sites hold it exactly.
        const Vec3 slope = difference(gradient, std::exp2(std::floor(std::log2(7e-4 * delta))));
        const Local<1> u = wall.derivatives(x, ball_radius);
        const double scale = u.gradient.norm() / delta + u.hessian.norm();
        CHECK((wall.radius_rate(x, ball_radius) - slope).norm() <= 100 * std::pow(epsilon, 0.8) * scale);
        const bool flat = site.region.shape == Shape::plane || site.region.shape == Shape::block;
        if (flat) CHECK(wall.radius_rate(x, ball_radius).norm() == 0);
      }
}

TEST_CASE("a wrong wall fails the check", "[laws][wall]") {
  int curved_sites = 0, cones = 0;
  for (const WallSite& site : wall_sites()) {
    const Points<1> x(site.point + 0.9 * ball_radius * site.normal);
    if (site.curved_surface) {
      CHECK_FALSE(check_law(WithoutBend{{{site.region, site.inside, 1e4, false}, ball_radius}}, x, 0.1 * ball_radius).empty());
      ++curved_sites;
    }
    if (site.region.shape == Shape::cone && site.radius_varies) {
      CHECK_FALSE(check_law(FixedRadius{{{site.region, site.inside, 1e4, true}, ball_radius}}, x, 0.1 * ball_radius).empty());
      ++cones;
    }
  }
  CHECK(curved_sites > 5);
  CHECK(cones > 1);
}

TEST_CASE("several faces at once add", "[laws][wall]") {
  std::array<WallTouch, WallContact::most_faces> touch;
  Region block;
  block.shape = Shape::block, block.lo = Vec3(-1, 0, 2), block.hi = Vec3(3, 4, 7);
  const AtWall corner{{block, true, 1e4, false}, ball_radius};
  const Vec3 in_corner(-0.6, 3.7, 2.45);
  CHECK(corner.wall.touches({in_corner, Vec3::Zero()}, ball_radius, 0, touch) == 3);
  CHECK(check_law(corner, Points<1>(in_corner), 0.05) == std::vector<std::string>{});
  Region tube = frustum(Shape::cylinder, 2, 2.5, 2.5);
  const AtWall end{{tube, true, 1e4, true}, ball_radius};
  const Vec3 in_end = tube.center + Vec3(0, 0, tube.axial_lo - tube.center[2] + 0.4) + 2.2 * Vec3(0.6, 0.8, 0);
  CHECK(end.wall.touches({in_end, Vec3::Zero()}, ball_radius, 0, touch) == 2);
  CHECK(check_law(end, Points<1>(in_end), 0.1) == std::vector<std::string>{});
  // Narrow rim of a cone, from inside: the nearest point of the side is its end.
  const Region cone = frustum(Shape::cone, 2, 3, 1.5);
  const AtWall rim{{cone, true, 1e4, true}, ball_radius};
  const Vec3 in_rim = cone.center + Vec3(0, 0, cone.axial_hi - cone.center[2] - 0.0625) + (1.5 - 0.375) * Vec3(0.6, 0.8, 0);
  REQUIRE(rim.wall.touches({in_rim, Vec3::Zero()}, ball_radius, 0, touch) == 2);
  CHECK(touch[0].gap == Approx(std::hypot(0.375, 0.0625) - ball_radius).epsilon(1e-13));
  CHECK(touch[0].effective_radius == Approx(ball_radius * 3 / 2.5).epsilon(1e-13));
  CHECK(check_law(rim, Points<1>(in_rim), 0.05) == std::vector<std::string>{});
}

TEST_CASE("what feels nothing of a wall", "[laws][wall]") {
  std::array<WallTouch, WallContact::most_faces> touch;
  for (const WallSite& site : wall_sites()) {
    INFO(site.name);
    const WallContact wall{site.region, site.inside, 1e4, true};
    const ExactVector clear{site.point + 1.25 * ball_radius * site.normal, Vec3::Zero()};
    CHECK(wall.value(clear, ball_radius) == 0);
    CHECK(wall.derivatives(clear, ball_radius).hessian.norm() == 0);
    CHECK(wall.touches(clear, ball_radius, 0.125 * ball_radius, touch) == 0);
    CHECK(wall.touches(clear, ball_radius, 0.375 * ball_radius, touch) == 1);
    CHECK(touch[0].gap == Approx(0.25 * ball_radius).epsilon(1e-12));
    CHECK(touch[0].force == 0);
    CHECK(WallContact{site.region, site.inside, 0, true}.value({site.point + 0.5 * ball_radius * site.normal, Vec3::Zero()}, ball_radius) == 0);
    if (site.region.any_open()) continue;
    const ExactVector behind{site.point - 0.01 * ball_radius * site.normal, Vec3::Zero()};    // the centre has left its side
    CHECK(wall.value(behind, ball_radius) == 0);
    CHECK(wall.touches(behind, ball_radius, ball_radius, touch) == 0);
    CHECK(WallContact{site.region, !site.inside, 1e4, false}.value(behind, ball_radius) > 0);
  }
}

TEST_CASE("a wall that has moved far has all digits of its gaps", "[laws][wall]") {
  const ExactVector way = two_product(1.0 / 3, Vec3(1000.1, -200.3, 77.7));
  for (const WallSite& site : wall_sites()) {
    INFO(site.name);
    const ExactVector here{site.point + (1 - 1e-9) * ball_radius * site.normal, Vec3::Zero()};
    const WallContact wall{site.region, site.inside, 1e4, false}, moved{site.region.moved_exactly(way, 0), site.inside, 1e4, false};
    std::array<WallTouch, WallContact::most_faces> before, after;
    REQUIRE(wall.touches(here, ball_radius, 0, before) == 1);
    REQUIRE(moved.touches(here + way, ball_radius, 0, after) == 1);
    CHECK(after[0].gap == Approx(before[0].gap).epsilon(4 * epsilon));
    CHECK((after[0].normal - before[0].normal).norm() <= 4 * epsilon);
    CHECK((after[0].point - before[0].point - way.hi).norm() <= 4 * epsilon * way.hi.norm());
    CHECK(on_side(moved.region.rounded(), site.inside, here + way) == on_side(site.region, site.inside, here));
  }
}

TEST_CASE("walls where they have no direction or no room: no NaN", "[laws][wall]") {
  Region ball;
  ball.shape = Shape::sphere, ball.center = Vec3(1, 2, 3), ball.radius = 0.4;
  for (const Region& region : {ball, frustum(Shape::cylinder, 2, 0.4, 0.4), frustum(Shape::cone, 2, 0.6, 0.0)})
    for (const bool inside : {true, false})
      for (const bool curved : {true, false})
        for (const bool open : {true, false})
          for (const double away : {0.0, 1e-170, 1e-9, 0.2, 0.4, 0.7})
            for (const double above : {0.0, 1.0, 2.0, 2.5}) {
              Region wall = region;
              if (region.shape != Shape::sphere && open) wall.open[0] = wall.open[1] = true;
              const WallContact contact{wall, inside, 1e4, curved};
              const ExactVector x{region.center + Vec3(0, away, above), Vec3::Zero()};
              const Local<1> u = contact.derivatives(x, ball_radius);
              CHECK_FALSE(std::isnan(u.value));
              CHECK(u.value == contact.value(x, ball_radius));
              CHECK(u.gradient.allFinite());
              CHECK(u.hessian.allFinite());
              CHECK(contact.radius_rate(x, ball_radius).allFinite());
            }
  // On the axis the curved wall does nothing, the caps do.
  const Region tube = frustum(Shape::cylinder, 2, 0.4, 0.4);
  const Vec3 on_axis(tube.center[0], tube.center[1], 0), at_cap(tube.center[0], tube.center[1], tube.axial_lo + 0.25);
  CHECK(WallContact{tube, true, 1e4, false}.value({on_axis, Vec3::Zero()}, ball_radius) == 0);
  const double energy = 8.0 / 15 * 1e4 * std::sqrt(ball_radius) * std::pow(0.25, 2.5);
  CHECK(WallContact{tube, true, 1e4, false}.value({at_cap, Vec3::Zero()}, ball_radius) == Approx(energy).epsilon(1e-13));
  CHECK(WallContact{ball, true, 1e4, false}.value({ball.center, Vec3::Zero()}, ball_radius) == 0);
  // ball_radius ≥ R: a curved wall has no room for it.
  const ExactVector in_ball{ball.center + Vec3(0, 0.2, 0), Vec3::Zero()};
  CHECK(WallContact{ball, true, 1e4, true}.value(in_ball, ball_radius) == std::numeric_limits<double>::infinity());
}
