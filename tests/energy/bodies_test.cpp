// Rigid bodies in the energy: derivatives, driven bodies, glued particles, objectivity, coordinates about a state.
#include "catch.hpp"
#include "chain.hpp"
#include "core/parallel.hpp"
#include "energy/collision_free_step.hpp"
#include "energy/energy.hpp"
#include "energy/load_difference.hpp"
#include "laws/check_law.hpp"
#include "laws/rounded/rotation.hpp"
#include "matrices.hpp"
#include "solve/bodies.hpp"

using namespace elamin;

namespace {

// A chain whose first two particles a box carries, boxes and a rod that press on it, on each other, on a free particle and on a
// plane; forces at points, torques, weights.
Model crowd(RoundedFormulation formulation) {
  Model m = chain(7, 50, 0.4, 0.5, Vec3(1, 0.2, -0.3));
  const Vec3 from = m.start.position.col(0);
  const Vec3 along = (Vec3(m.start.position.col(6)) - from).normalized();
  add_body(m, box_core(Vec3(0.8, 0.6, 0.5)), 0.2, pose(from - 0.35 * along, Vec3(0.3, -0.2, 0.1)), 2);
  add_body(m, cube_core(0.7), 0.15, pose(from + Vec3(-0.55, 0.2, 1.02), Vec3(0.4, 0.3, -0.7)), 2);
  add_body(m, rod_core(1.2), 0.25, pose(from + Vec3(0.2, -0.95, 0.1), Vec3(-0.2, 0.5, 0.9)), 2);
  add_body(m, tetrahedron_core(0.9), 0.1, pose(from + 2.2 * along + Vec3(0.1, 0.75, 0.2), Vec3(1, 0.2, -0.5)), 2);
  for (const int p : {0, 1})
    m.glued.push_back({p, 0, m.start.bodies[0].rotation.conjugate() * (Vec3(m.start.position.col(p)) - m.start.bodies[0].position.hi)});
  RoundedPair t;
  t.particles = {std::vector{2, 3, 4, 5, 6}, std::vector{2, 3, 4, 5, 6}};
  t.bodies = {std::vector{0, 1, 2, 3}, std::vector{0, 1, 2, 3}};
  t.formulation = formulation;
  t.kernel = {30, 2, 0.3, RoundedKernel::Form::coded};
  m.rounded.push_back(t);
  Wall floor;
  floor.region.shape = Shape::plane, floor.region.center = from + Vec3(0, 0, -0.42), floor.region.normal = Vec3(0.1, -0.2, 1).normalized();
  floor.bodies = {0, 1, 2, 3};
  floor.kernel.normal = 20;
  floor.displacement = Vec3(0.02, 0.01, 0.05);
  m.walls.push_back(floor);
  Load push;
  push.particles = {1, 5}, push.bodies = {0, 1}, push.force = Vec3(0.4, -0.3, 0.2), push.point = Vec3(0.1, 0.2, -0.15);
  m.loads.push_back(push);
  Load twist;
  twist.bodies = {1, 2}, twist.torque = Vec3(0.5, 0.3, -0.6), twist.scaling = {0.5, 1};
  m.loads.push_back(twist);
  Gravity g;
  g.particles = {0, 1, 2, 3, 4, 5, 6}, g.bodies = {0, 1, 2, 3}, g.acceleration = Vec3(0.1, 0.2, -0.5);
  m.gravity.push_back(g);
  return m;
}

const double accuracy_of_bodies = 200 * std::pow(epsilon, 0.8);

}  // namespace

TEST_CASE("the shares of particles and bodies add up to the energy of all laws, a glued particle has its own", "[energy][bodies]") {
  const Model model = crowd(RoundedFormulation::multi);
  Energy energy(model);
  const State state = bent(energy, 0.7, 0.03);
  const EnergyTerms terms = energy.terms(state);
  const Vector shares = energy.shares(state);
  REQUIRE(shares.size() == 7 + 4);
  CHECK(shares.sum() == Approx(terms.total() - terms.external).epsilon(1e-13));
  Model alone = model;
  alone.rounded.clear(), alone.walls.clear();
  const Vector of_chain = Energy(alone).shares(state);
  CHECK(of_chain[0] > 0);
  CHECK(of_chain.tail(4).isZero(0));
  CHECK(of_chain.sum() == Approx(terms.bond + terms.angle).epsilon(1e-13));
}

TEST_CASE("with bodies the assembled energy agrees with its differences", "[energy][bodies]") {
  const RoundedFormulation formulation = GENERATE(RoundedFormulation::multi, RoundedFormulation::closest);
  const Model model = crowd(formulation);
  Energy energy(model);
  const State state = bent(energy, 0.7, 0.03);
  energy.evaluate(state);
  const Vector g = energy.gradient();
  const Eigen::MatrixXd H = whole(energy.hessian());
  CHECK(energy.dofs() == 5 * 3 + 4 * 6);
  CHECK(energy.null_dofs().empty());
  CHECK(std::abs(energy.last_terms().body) > 0.01);
  CHECK(energy.last_terms().wall > 0.01);
  CHECK(energy.last_terms().total() == energy.value(state));
  const auto along = [&](int k, double s) {
    State moved = state;
    energy.kinematics().retract(moved, Vector::Unit(energy.dofs(), k), s);
    return moved;
  };
  Eigen::MatrixXd D(energy.dofs(), energy.dofs());
  for (int k = 0; k < energy.dofs(); ++k) {
    const double slope = difference([&](double s) { return energy.value(along(k, s)); }, difference_step);
    CHECK(std::abs(slope - g[k]) <= accuracy_of_bodies * H.norm());
    D.col(k) = difference([&](double s) -> Vector { energy.evaluate(along(k, s), false); return energy.gradient(); }, difference_step);
  }
  // Turns about a turned body: ∂g differs from the Hessian by the antisymmetric [g]×/2.
  CHECK(((D + D.transpose()) / 2 - H).cwiseAbs().maxCoeff() <= accuracy_of_bodies * H.norm());
  energy.evaluate(state);
  Vector v(energy.dofs());
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = std::cos(2.3 * static_cast<double>(k));
  CHECK((energy.multiply(v) - H * v).norm() <= 100 * epsilon * H.norm() * v.norm());
  CHECK(std::abs(energy.quadratic_form(v) - v.dot(H * v)) <= 100 * epsilon * H.norm() * v.squaredNorm());
}

TEST_CASE("with bodies ∂g/∂λ agrees with differences in the load factor", "[energy][bodies]") {
  Model model = crowd(RoundedFormulation::multi);
  Support turned;
  turned.bodies = {1}, turned.displacement = Vec3(0.1, -0.2, 0.05), turned.constrained_rotations = {true, true, true}, turned.rotation = Vec3(0.3, -0.2, 0.5);
  Support pushed;
  pushed.bodies = {2}, pushed.held = {true, false, true}, pushed.displacement = Vec3(0.1, 0, -0.1);
  Support clamped;
  clamped.bodies = {0}, clamped.constrained_rotations = {true, true, true}, clamped.rotation = Vec3(-0.1, 0.2, 0.1);
  const bool clamp = GENERATE(false, true);
  model.supports = {turned, pushed};
  if (clamp) model.supports.push_back(clamped);
  Energy energy(model);
  CHECK(energy.dofs() == 5 * 3 + (clamp ? 0 : 6) + 0 + 4 + 6);
  const State state = bent(energy, 0.4, 0.02);
  energy.evaluate(state);
  const Vector exact = energy.load_derivative();
  const double scale = whole(energy.hessian()).norm();
  CHECK((exact - load_difference(energy, state, difference_step)).cwiseAbs().maxCoeff() <= accuracy_of_bodies * scale);
  CHECK(exact.norm() > 0.1);
}

TEST_CASE("coordinates about another state have derivatives of their own", "[energy][bodies]") {
  const Model model = crowd(RoundedFormulation::closest);
  Energy energy(model);
  const State origin = bent(energy, 0.7, 0);
  Vector y(energy.dofs());
  for (Eigen::Index k = 0; k < y.size(); ++k) y[k] = 0.05 * std::sin(1.3 * static_cast<double>(k));
  y *= 1 + 0.1 * GENERATE(0, 1, 2);
  const auto at = [&](const Vector& z) {
    State s = origin;
    energy.kinematics().retract(s, z);
    return s;
  };
  const auto gradient = [&](const Vector& z) {
    energy.evaluate(at(z), false);
    Vector g = energy.gradient();
    energy.kinematics().pull_back(g, z);
    return g;
  };
  const Vector g = gradient(y);
  energy.evaluate(at(y));
  const Vector here = energy.gradient();
  energy.kinematics().pull_back(energy.changeable_hessian(), here, y);
  const Eigen::MatrixXd H = whole(energy.hessian());
  CHECK((energy.kinematics().difference(origin, at(y)) - y).norm() <= 1e-14 * y.norm());
  for (int k = 0; k < energy.dofs(); ++k) {
    const Vector e = Vector::Unit(energy.dofs(), k);
    CHECK(std::abs(difference([&](double s) { return energy.value(at(y + s * e)); }, difference_step) - g[k]) <= accuracy_of_bodies * H.norm());
    const Vector column = difference([&](double s) -> Vector { return gradient(y + s * e); }, difference_step);
    CHECK((column - H.col(k)).cwiseAbs().maxCoeff() <= accuracy_of_bodies * H.norm());
  }
}

TEST_CASE("the torque of a load follows a turn by more than half a circle", "[energy][bodies]") {
  const RotationTorque torque{Vec3(0.3, -0.8, 0.5), quaternion(Vec3(0.2, 0.1, -0.4))};
  for (const double angle : {0.0, 1e-3, 0.04, 0.06, 1.0, 3.0, 3.3, 5.0}) {
    const Eigen::Quaterniond q = quaternion(angle * Vec3(0.48, 0.6, -0.64)) * torque.from;
    const Local<1> u = torque.derivatives(q);
    const auto at = [&](int k, double s) { return quaternion(s * Vec3::Unit(k)) * q; };
    Mat3 D;
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(difference([&](double s) { return torque.value(at(k, s)); }, difference_step) - u.gradient[k]) <= accuracy_of_bodies);
      D.col(k) = difference([&](double s) -> Vec3 { return torque.derivatives(at(k, s)).gradient; }, difference_step);
    }
    CHECK(((D + D.transpose()) / 2 - u.hessian).norm() <= (angle > 4 ? 100 : 1) * accuracy_of_bodies);
  }
}

TEST_CASE("turned as a whole, bodies have the same energy and turned forces", "[energy][bodies]") {
  const RoundedFormulation formulation = GENERATE(RoundedFormulation::multi, RoundedFormulation::closest);
  Model model = crowd(formulation);
  model.walls.clear(), model.loads.clear(), model.gravity.clear();
  Energy energy(model);
  const State state = bent(energy, 0, 0.03);
  const Eigen::Quaterniond q = quaternion(Vec3(0.7, -1.1, 0.4));
  State turned = state;
  for (int p = 0; p < model.particles(); ++p) turned.set(p, {q * Vec3(state.position.col(p)), q * Vec3(state.low.col(p))});
  for (Pose& b : turned.bodies) b.position = {q * b.position.hi, q * b.position.lo}, b.rotation = q * b.rotation;
  const Field before = energy.forces(state);
  const double size = energy.last_terms().size(), e = energy.last_terms().total();
  const Field after = energy.forces(turned);
  CHECK(std::abs(energy.last_terms().total() - e) <= 1e-12 * size);
  CHECK((after - q.toRotationMatrix() * before).norm() <= 1e-12 * before.norm());
  // No net force and no net torque; glued particles' forces are in those of their body.
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int p = 2; p < model.particles(); ++p) force += before.col(p), moment += Vec3(state.position.col(p)).cross(Vec3(before.col(p)));
  for (int b = 0; b < 4; ++b) {
    const Vec3 f = before.col(energy.kinematics().place_of(b));
    force += f;
    moment += state.bodies[b].position.hi.cross(f) + energy.kinematics().characteristic_length(b) * before.col(energy.kinematics().rotation_of(b));
  }
  CHECK(force.norm() <= 1e-13 * before.norm());
  CHECK(moment.norm() <= 1e-12 * before.norm());
}

TEST_CASE("a step ends before a body passes through another one, a particle or a wall", "[energy][bodies]") {
  Model model;
  model.start = State(Field(3, 1));
  model.start.position.col(0) = Vec3(0, 0, 3);
  model.id = model.type = model.molecule = {1};
  model.diameter = model.density = {0.5};
  add_body(model, cube_core(1), 0.1, pose(Vec3(0, 0, 0), Vec3::Zero()), 2);
  add_body(model, rod_core(1), 0.1, pose(Vec3(3, 0.1, 0), Vec3(0, 0, 1)), 2);
  RoundedPair t;
  t.particles = {std::vector{0}, std::vector<int>{}}, t.bodies = {std::vector{0, 1}, std::vector{0, 1}};
  t.kernel.normal = 10;
  model.rounded.push_back(t);
  Wall wall;
  wall.region.shape = Shape::plane, wall.region.center = Vec3(0, 0, -2), wall.region.normal = Vec3::UnitZ(), wall.bodies = {0, 1};
  wall.kernel.normal = 10;
  model.walls.push_back(wall);
  const double size = GENERATE(1e-3, 1.0, 1e3);
  for (auto* v : {&model.start.position}) *v *= size;
  model.shapes = {rounded_shape(cube_core(size), 0.1 * size), rounded_shape(rod_core(size), 0.1 * size)};
  for (Pose& p : model.start.bodies) p.position.hi *= size;
  model.diameter[0] *= size, model.walls[0].region.center *= size;
  Energy energy(model);
  const auto part = [&](const Vec3& cube, const Vec3& rod) {
    State to = model.start;
    to.bodies[0].position.hi += size * cube, to.bodies[1].position.hi += size * rod;
    return energy.collision_free_step(model.start, to);
  };
  CHECK(part(Vec3::Zero(), Vec3::Zero()) == 1);
  CHECK(part(Vec3(0, 5, 0), Vec3(0, 5, 0)) == 1);
  CHECK(part(Vec3(0, 5, 0), Vec3(0, -5, 0)) == 1);
  const double through = part(Vec3::Zero(), Vec3(-6, 0, 0));
  CHECK(through > 0.25);
  CHECK(through < 0.4);
  const double up = part(Vec3(0, 0, 4), Vec3::Zero());             // 2.5 to the particle's centre, of 4
  CHECK(std::abs(up - 0.8 * 2.5 / 4) <= 0.01);
  const double down = part(Vec3(0, 0, -4), Vec3::Zero());          // 1.5 to the plane
  CHECK(std::abs(down - 0.8 * 1.5 / 4) <= 0.01);
}
