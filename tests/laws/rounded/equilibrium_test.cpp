// The derivatives of pairs and walls together find equilibria, as a solver would.
#include "catch.hpp"
#include "core/dense.hpp"
#include "laws/rounded/bodies.hpp"
#include "laws/rounded/multi.hpp"
#include "laws/rounded/wall.hpp"

using namespace elamin;

namespace {

/// Two bodies on a floor with weights, energies and derivatives of everything.
struct Stack {
  RoundedMulti pair;
  RoundedWall floor;
  double weight_a, weight_b;

  PairLocal derivatives(const Couple& c) const {
    PairLocal u = pair.derivatives(c.a, c.b);
    int at = 0;
    for (const RoundedBody* body : {&c.a, &c.b}) {
      const Local<2> w = floor.derivatives(*body);
      u.gradient.segment<6>(at) += w.gradient, u.hessian.block<6, 6>(at, at) += w.hessian;
      at += 6;
    }
    u.gradient[2] += weight_a, u.gradient[8] += weight_b;
    return u;
  }
};

}  // namespace

TEST_CASE("Newton's method finds a stack of two boxes on a floor and their overlaps", "[laws][rounded]") {
  const RoundedShape large = rounded_shape(box_core({1.2, 1.0, 0.8}), 0.1), small = rounded_shape(box_core({0.7, 0.6, 0.9}), 0.15);
  Region floor;
  const double wall = 400, k = 100, weight_a = 3, weight_b = 2;
  const Stack stack{RoundedMulti{{k, 0, 0, RoundedKernel::Form::coded}}, {floor, true, {wall, 0, 0}}, weight_a, weight_b};
  Couple c{placed(large, {0, 0, 0.48}, quaternion({0.01, -0.015, 0.3})), placed(small, {0, 0, 1.54}, quaternion({-0.02, 0.01, 0.9}))};
  const std::vector<int> free{2, 3, 4, 8, 9, 10};                      // nothing holds them sideways: x, y and θ_z are held
  double last = 1;
  int quadratic = 0;
  for (int step = 0; step < 10; ++step) {
    PairLocal u = stack.derivatives(c);
    Eigen::Matrix<double, 12, 1> move = Eigen::Matrix<double, 12, 1>::Zero();
    move(free) = -solved(u.hessian(free, free), u.gradient(free));
    c = moved(c, move);
    u = stack.derivatives(c);
    const double residual = u.gradient(free).norm();
    quadratic += residual < last * last && residual > 1e-12;
    last = residual;
  }
  CHECK(last <= 1e-13 * (weight_a + weight_b));
  CHECK(quadratic >= 2);
  // Four corners on the floor, four corners on the face.
  CHECK(c.a.pose.position.hi.z() == Approx(0.4 + 0.1 - (weight_a + weight_b) / (4 * wall)).epsilon(1e-14));
  const double apart = (c.b.pose.position - c.a.pose.position).hi.z();
  CHECK(apart == Approx(0.4 + 0.45 + 0.25 - weight_b / (4 * k)).epsilon(1e-14));
  for (const RoundedBody& body : {c.a, c.b}) CHECK((body.pose.rotation * Vec3::UnitZ() - Vec3::UnitZ()).norm() <= 1e-14);
}
