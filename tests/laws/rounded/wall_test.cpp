#include "laws/rounded/wall.hpp"

#include "catch.hpp"
#include "laws/rounded/check_pair.hpp"
#include "laws/rounded/lammps_case.hpp"
#include "laws/wall_sites.hpp"

using namespace elamin;

namespace {

/// A wall as a law of a pair whose other body does nothing.
struct OneBody {
  RoundedWall wall;
  double value(const RoundedBody& a, const RoundedBody&) const { return wall.value(a); }
  PairLocal derivatives(const RoundedBody& a, const RoundedBody&) const {
    PairLocal u;
    const Local<2> one = wall.derivatives(a);
    u.value = one.value, u.gradient.head<6>() = one.gradient, u.hessian.topLeftCorner<6, 6>() = one.hessian;
    return u;
  }
};

Region plane(int axis, double at, double sign) {
  Region half;
  half.center[axis] = at, half.normal = sign * Vec3::Unit(axis);
  return half;
}

}  // namespace

TEST_CASE("a body on planes has the energy, forces and torques of the reference", "[laws][rounded]") {
  const ReferenceCase c = reference_case("walls");
  Wrenches w(c.bodies.size());
  for (const RoundedWall& wall
      : {RoundedWall{plane(2, 0, 1), true, {500, 0, 0}}, RoundedWall{plane(0, 5, -1), true, {300, 0, 0}}})
    for (std::size_t k = 0; k < c.bodies.size(); ++k) {
      const Local<2> u = wall.derivatives(c.body(k));
      w.energy += u.value, w.forces[k] -= u.gradient.head<3>(), w.torques[k] -= u.gradient.tail<3>();
    }
  CHECK(w.off(c.expected["potential"]["walls"]) <= 1e-12);
  CHECK(w.energy > 1);
}

TEST_CASE("bodies at walls agree with differences of their energy", "[laws][rounded]") {
  std::mt19937 random(23);
  std::vector<RoundedWall> walls{{plane(2, -0.4, 1), true, {50, 4, 0.3}}, {plane(2, 0.8, 1), false, {50, 4, 0.3}}};
  Region box, tube = frustum(Shape::cylinder, 2, 1.0, 1.0), ball;
  box.shape = Shape::block, box.lo = Vec3(-0.8, -1, -0.8), box.hi = Vec3(0.8, 0.9, 1);
  tube.center = Vec3::Zero();
  ball.shape = Shape::sphere, ball.radius = 1.0;
  for (const Region& r : {box, tube, ball}) walls.push_back({r, true, {50, 4, 0.3}});
  for (const RoundedWall& wall : walls) {
    CHECK(wall.exact());
    int pressed = 0, attracted = 0;
    for (const NamedShape& s : test_shapes())
      for (int k = 0; k < 5; ++k) {
        INFO(s.name << ", " << k);
        const RoundedBody body = placed(s.shape, 0.05 * random_vector(random), random_rotation(random));
        const Couple c{body, body};
        const AtPoses<OneBody> at{{wall}, c, 1.0};
        const PairLocal u = at.derivatives(Points<4>());
        std::vector<RoundedWallTouch> touch;
        wall.touches(body, touch);
        Vec3 force = Vec3::Zero();
        for (const RoundedWallTouch& t : touch) {
          force += t.force * t.normal;
          (t.force > 0 ? pressed : attracted) += t.force != 0;
        }
        CHECK((force + u.gradient.head<3>()).norm() <= 1e-12);
        const double h = 1e-5, size = u.gradient.norm() + u.hessian.norm();
        for (int m = 0; m < 6; ++m) {
          CHECK(std::abs(difference([&](double x) { return at.value(moved<4>({}, m, x)); }, h) - u.gradient[m]) <=
              1e-9 * (1 + size));
          const auto gradient = [&](double x) -> Eigen::Matrix<double, 12, 1> {
            return at.derivatives(moved<4>({}, m, x)).gradient;
          };
          const Eigen::Matrix<double, 12, 1> column = difference(gradient, h);
          CHECK((column - u.hessian.col(m)).norm() <= 1e-7 * (1 + size));
        }
      }
    CHECK(pressed >= 5);
    CHECK(attracted >= 5);
  }
  RoundedWall outside{ball, false, {50, 0, 0}};
  CHECK(!outside.exact());
}
