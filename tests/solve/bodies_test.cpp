// Bodies at rest, each with a closed form.
#include "solve/bodies.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "laws/rounded/rotation.hpp"
#include "path/equilibrium.hpp"
#include "solve/ipopt.hpp"
#include "solve/method.hpp"

#include <random>

using namespace elamin;

namespace {

bool names(const Equilibrium& e, const std::string& part) {
  for (const std::string& name : e.point.stability.zero_modes)
    if (name.find(part) != std::string::npos) return true;
  return false;
}

// n boxes that become smaller upwards, or cubes of one size each turned by half a right angle; they nearly touch.
struct Pile {
  Model model;
  double weight = 0.7, k = 800, floor = 500, radius = 0.1, height = 1.2;
  int n;
  Pile(int count, bool turned, double gap) : n(count) {
    for (int b = 0; b < n; ++b) {
      const double edge = turned ? 2 : 3 * std::pow(0.65, b);    // a box that spins stays within the one below
      add_body(model, box_core(Vec3(edge, edge, 1)), radius, pose(Vec3(0, 0, height / 2 + b * height + (b + 1) * gap), Vec3(0, 0, turned && b % 2 ? pi / 4 : 0)), weight);
    }
    add_contacts(model, {k, 0, 0, RoundedKernel::Form::coded});
    add_plane(model, Vec3::Zero(), Vec3::UnitZ(), floor);
    add_weight(model, Vec3(0, 0, -1));
  }
  /// Four vertices on a face; of two squares turned against each other the edges cross eight times.
  double overlap(int b, int contacts) const { return (n - b) * weight / (b == 0 ? 4 * floor : contacts * k); }
};

State jolted(const Model& model, const Energy& energy, double size) {
  State state = model.start;
  Vector step(energy.dofs());
  for (Eigen::Index k = 0; k < step.size(); ++k) step[k] = size * std::sin(1.7 * static_cast<double>(k));
  energy.kinematics().retract(state, step);
  return state;
}

}  // namespace

TEST_CASE("a stack of boxes sinks into itself by the weight above over the stiffness of its contacts", "[solve][bodies]") {
  const bool turned = GENERATE(false, true);
  Pile pile(5, turned, GENERATE(-5e-3, 1e-3, 5e-3, 0.2));
  hold_bodies(pile.model, all_bodies(pile.model), {true, true, false}, {turned, turned, turned});
  Energy energy(pile.model);
  Newton newton(energy);
  State state = jolted(pile.model, energy, 2e-3);
  const Report report = newton.minimise(state);
  INFO(report.why << " after " << report.iterations);
  REQUIRE(report.converged());
  CHECK(report.residual <= 1e-10);
  CHECK(report.iterations < 60);
  double z = pile.height / 2;
  for (int b = 0; b < pile.n; ++b) {
    z -= pile.overlap(b, turned ? 8 : 4);
    CHECK(std::abs(place(state, b)[2] - z) <= 1e-9);
    z += pile.height;
  }
  const Equilibrium e = assess(newton, state, report);
  CHECK(e.point.stability.zero == (turned ? 0 : 5));             // each may spin
  CHECK(e.point.stability.stable);
  const std::vector<Touch> touches = energy.touches(state);
  CHECK(touches.size() == 4u + (turned ? 8u : 4u) * (pile.n - 1));
  Vec3 on_top = Vec3::Zero(), on_floor = Vec3::Zero();
  for (const Touch& t : touches) {
    CHECK(t.feature >= 0);
    if (t.other == pile.n - 1) on_top -= t.force;
    if (t.wall == 0) on_floor += t.force;
  }
  CHECK((on_top - Vec3(0, 0, pile.weight)).norm() <= 1e-9);
  CHECK((on_floor - Vec3(0, 0, pile.n * pile.weight)).norm() <= 1e-9);
}

TEST_CASE("all methods find the same stack", "[solve][bodies]") {
  const std::string name = GENERATE("newton", "ipopt", "LD_LBFGS", "LD_TNEWTON");
  Pile pile(4, false, GENERATE(2e-3, 0.1));
  hold_bodies(pile.model, all_bodies(pile.model), {true, true, false}, {false, false, false});   // nothing else keeps a box from sliding
  Energy energy(pile.model);
  Newton newton(energy);
  const Method method = name == "newton" ? Method(NewtonOptions{}) : name == "ipopt" ? Method(IpoptOptions{}) : Method(NloptOptions{.algorithm = name});
  State state = jolted(pile.model, energy, 2e-3);
  const Report report = minimise(newton, state, method);
  INFO(name << ": " << report.why << " after " << report.iterations);
  REQUIRE(report.converged());
  double z = pile.height / 2;
  for (int b = 0; b < pile.n; ++b) {
    z -= pile.overlap(b, 4);
    CHECK(std::abs(place(state, b)[2] - z) <= 1e-9);
    z += pile.height;
  }
}

TEST_CASE("what bodies are free to do is named", "[solve][bodies]") {
  Model m;
  add_body(m, cube_core(1), 0.1, pose(Vec3(0, 0, 0.599)));
  add_body(m, rod_core(1), 0.2, pose(Vec3(5, 0, 0.199), Vec3(0, 0, 0.6)));
  add_body(m, point_core(), 0.5, pose(Vec3(9, 0, 0.499)));
  add_contacts(m, {100, 0, 0, RoundedKernel::Form::coded});
  const Vec3 n = GENERATE(Vec3(0, 0, 1), Vec3(0.6, 0, 0.8));
  const Eigen::Quaterniond q = shortest_rotation(Vec3(0, 0, 1), n);
  for (Pose& p : m.start.bodies) p.position.hi = q * p.position.hi, p.rotation = q * p.rotation;
  add_plane(m, Vec3::Zero(), n, 100);
  add_weight(m, -n);
  add_body(m, tetrahedron_core(1), 0.1, pose(q * Vec3(20, 20, 20)));
  hold_bodies(m, {3}, {true, false, false}, {false, false, false});
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  const Report report = newton.minimise(state);
  INFO(report.why);
  REQUIRE(report.converged());
  const Equilibrium e = assess(newton, state, report);
  CHECK(e.point.stability.stable);
  std::string all;
  for (const std::string& z : e.point.stability.zero_modes) all += z + "\n";
  INFO(all);
  CHECK(e.point.stability.zero == 3 + 4 + 5 + 5);     // the rod besides spins about its line, the sphere about any
  CHECK(names(e, "rattler: body 4 touches nothing"));
  CHECK(names(e, "rotation of body 3"));
  if (n == Vec3(0, 0, 1)) {
    CHECK(names(e, "translation of body 1 along x, y"));
    CHECK(names(e, "rotation of body 1 about z"));
  } else {
    CHECK(names(e, "rotation of body 1 about (0.6, 0, 0.8)"));
    CHECK(names(e, "translation of body 1 along y"));
    CHECK(names(e, "rotation of body 2 about"));
  }
}

// A rod leans: its lower end on the floor, held there by a horizontal force F, its upper end at a wall. Moments about the lower
// end: W (L/2) cos θ = F L sin θ.
TEST_CASE("a leaning rod stands where its moments balance", "[solve][bodies]") {
  const double L = 2, rho = 0.1, W = 0.8, k = 300, wall = 200, theta = GENERATE(0.5, 1.0);
  const double F = W / (2 * std::tan(theta));
  const Vec3 low(rho - F / wall + L * std::cos(theta), 0, rho - W / k);
  Model m;
  const double K = 5, stretch = F / (2 * K);                    // U = K (r − r₀)²
  m.start = State(Field(3, 2));
  m.start.position.col(0) = low + Vec3(1, 0, 0), m.start.position.col(1) = low;
  m.id = {1, 2}, m.type = m.molecule = {1, 1}, m.diameter = m.density = {0.01, 0.01};
  m.bond_types = {{K, 1.0 + stretch}}, m.bonds = {{0, {0, 1}}};
  hold(m, 0, 0);
  add_body(m, rod_core(L), rho, pose(low + L / 2 * Vec3(-std::cos(theta), 0, std::sin(theta)), Vec3(0, theta, 0)), W);
  m.glued.push_back({1, 0, Vec3(L / 2, 0, 0)});
  add_plane(m, Vec3::Zero(), Vec3::UnitZ(), k);
  add_plane(m, Vec3::Zero(), Vec3::UnitX(), wall, "wall");
  add_weight(m, Vec3(0, 0, -1));
  hold_bodies(m, {0}, {false, true, false}, {true, false, true});
  Energy energy(m);
  CHECK(energy.dofs() == 3);
  Newton newton(energy);
  energy.evaluate(m.start);
  CHECK(energy.relative(energy.gradient()) <= 1e-12);
  State state = m.start;
  Vector step(3);
  step << 5e-4, -3e-4, 6e-4;                                    // less than the overlaps
  energy.kinematics().retract(state, step);
  const Report report = newton.correct(state);
  INFO(report.why);
  REQUIRE(report.converged());
  CHECK(energy.kinematics().difference(m.start, state).norm() <= 1e-9);
  // δF at the bond against the moment: stable if 2 K L sin²θ > W/(2 sin θ) … here by the Hessian of the closed form.
  for (const Touch& t : energy.touches(state)) {
    CHECK(std::abs(t.force.norm() - (t.wall == 0 ? W : F)) <= 1e-9);
    CHECK((t.point - (t.wall == 0 ? Vec3(low[0], 0, 0) : Vec3(0, 0, low[2] + L * std::sin(theta)))).norm() <= 1e-9);
  }
  CHECK(energy.touches(state).size() == 2);
}

// Springs in series: two walls with four vertices each, n − 1 contacts of four.
TEST_CASE("a row of cubes between walls is springs in series", "[solve][bodies]") {
  const int n = GENERATE(1, 2, 5);
  const RoundedFormulation formulation = GENERATE(RoundedFormulation::multi, RoundedFormulation::closest);
  const double k = 40, wall = 70, rho = 0.15, edge = 1, size = edge + 2 * rho, squeeze = 0.02;
  Model m;
  for (int b = 0; b < n; ++b) add_body(m, cube_core(edge), rho, pose(Vec3((b + 0.5) * size, 0, 0)));
  add_contacts(m, {k, 0, 0, RoundedKernel::Form::coded}, formulation);
  add_plane(m, Vec3::Zero(), Vec3::UnitX(), wall, "left");
  add_plane(m, Vec3(n * size, 0, 0), -Vec3::UnitX(), wall, "right").displacement = Vec3(-squeeze, 0, 0);
  std::vector<int> all(n);
  for (int b = 0; b < n; ++b) all[b] = b;
  hold_bodies(m, all, {false, true, true}, {true, true, true});
  const int contacts = formulation == RoundedFormulation::multi ? 4 : 1;
  const double force = squeeze / (2 / (4 * wall) + (n - 1) / (contacts * k));
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  energy.kinematics().prescribe(state, 1);
  const Report report = newton.minimise(state);
  INFO(report.why << " " << report.iterations);
  REQUIRE(report.converged());
  CHECK(std::abs(report.energy - force * squeeze / 2) <= 1e-9);
  Vec3 on_left = Vec3::Zero(), on_right = Vec3::Zero();
  for (const Touch& t : energy.touches(state))
    if (t.wall >= 0) (t.wall == 0 ? on_left : on_right) += t.force;
  CHECK((on_left - Vec3(force, 0, 0)).norm() <= 1e-9);
  CHECK((on_right + Vec3(force, 0, 0)).norm() <= 1e-9);
}

TEST_CASE("a beam clamped to a body is a clamped beam", "[solve][bodies]") {
  const int n = 12;
  const double q = 0.1, K = 50, B = 0.3, angle = 0.4;
  const auto loaded = [&] {
    Model m = chain(n, K, B, q, Vec3::UnitX());
    Load l;
    l.particles = {n - 1}, l.force = Vec3(0.05, 0.02, 0.1);
    m.loads.push_back(l);
    return m;
  };
  // Two particles held where the rotation takes them …
  Model held = loaded();
  hold(held, 0, 0);
  hold(held, 1, 1, {true, true, true}, q * Vec3(std::cos(angle) - 1, 0, -std::sin(angle)));
  Energy energy(held);
  Newton newton(energy);
  State straight = held.start;
  energy.kinematics().prescribe(straight, 1);
  REQUIRE(newton.minimise(straight).converged());
  // … or carried by a box that a support turns …
  Model turned = loaded();
  add_body(turned, box_core(Vec3(0.4, 0.3, 0.3)), 0.05, pose(Vec3(-0.1, 0, 0)));
  turned.glued = {{0, 0, Vec3(0.1, 0, 0)}, {1, 0, Vec3(0.1 + q, 0, 0)}};
  Support s;
  s.bodies = {0}, s.constrained_rotations = {true, true, true}, s.rotation = Vec3(0, angle, 0);
  s.displacement = Vec3(0.1, 0, 0) - quaternion(Vec3(0, angle, 0)) * Vec3(0.1, 0, 0);      // the first particle stays
  turned.supports.push_back(s);
  Energy of_turned(turned);
  Newton newton_turned(of_turned);
  State by_body = turned.start;
  of_turned.kinematics().prescribe(by_body, 1);
  const Report report = newton_turned.minimise(by_body);
  INFO(report.why);
  REQUIRE(report.converged());
  CHECK((by_body.position - straight.position).cwiseAbs().maxCoeff() <= 1e-9);
  // … or that the torque of that support turns.
  const Field forces = of_turned.forces(by_body);
  const Vec3 torque = -of_turned.kinematics().characteristic_length(0) * forces.col(of_turned.kinematics().rotation_of(0));
  const Vec3 tip = by_body.position.col(n - 1), body = place(by_body, 0);
  const Vec3 moment = (tip - body).cross(Vec3(held.loads[0].force));
  CHECK((torque + moment).norm() <= 1e-9 * moment.norm());
  Model twisted = turned;
  twisted.supports.clear();
  hold_bodies(twisted, {0}, {true, true, true}, {true, false, true});
  twisted.supports[0].displacement = s.displacement;
  Load twist;
  twist.bodies = {0}, twist.torque = Vec3(0, torque[1], 0);
  twisted.loads.push_back(twist);
  Energy of_twisted(twisted);
  Newton newton_twisted(of_twisted);
  State near = by_body;
  of_twisted.kinematics().retract(near, Vector::Constant(of_twisted.dofs(), 1e-3));
  REQUIRE(newton_twisted.correct(near).converged());
  CHECK((near.position - by_body.position).cwiseAbs().maxCoeff() <= 1e-9);
  CHECK(rotation_between(near.bodies[0].rotation, by_body.bodies[0].rotation).norm() <= 1e-9);
}

TEST_CASE("a pile of many kinds of bodies comes to rest in a box", "[solve][bodies]") {
  Model m;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto vector = [&] { const double x = u(random), y = u(random); return Vec3(x, y, u(random)); };
  for (int k = 0; k < 20; ++k) {
    const Vec3 x = Vec3(k % 2 ? 0.75 : -0.75, (k / 2) % 2 ? 0.75 : -0.75, 0.85 + 1.55 * (k / 4)) + 0.05 * vector();
    const Pose at = pose(x, 2 * vector());
    if (k % 5 == 0) add_body(m, cube_core(0.6), 0.1, at);
    else if (k % 5 == 1) add_body(m, tetrahedron_core(0.8), 0.12, at);
    else if (k % 5 == 2) add_body(m, rod_core(0.9), 0.15, at);
    else if (k % 5 == 3) add_body(m, box_core(Vec3(0.8, 0.5, 0.4)), 0.08, at);
    else add_body(m, point_core(), 0.4, at);
  }
  add_contacts(m, {2000, 0, 0, RoundedKernel::Form::coded});
  Wall box;
  box.name = "box", box.bodies = all_bodies(m);
  box.region.shape = Shape::block, box.region.lo = Vec3(-1.5, -1.5, 0), box.region.hi = Vec3(1.5, 1.5, 40);
  box.kernel.normal = 2000;
  m.walls.push_back(box);
  add_weight(m, Vec3(0, 0, -1));
  Energy energy(m);
  Newton newton(energy, NewtonOptions{.max_iterations = 3000});
  State state = m.start;
  const bool by_ipopt = GENERATE(false, true);
  const Report report = by_ipopt ? minimise(newton, state, IpoptOptions{.max_iterations = 3000}) : newton.minimise(state);
  INFO((by_ipopt ? "ipopt: " : "newton: ") << report.why << " after " << report.iterations);
  REQUIRE(report.converged());
  CHECK(report.residual <= 1e-10);
  CHECK(assess(newton, state, report).point.stability.stable);
  Vec3 floor = Vec3::Zero();
  for (const Touch& t : energy.touches(state))
    if (t.wall == 0) floor += t.force;
  CHECK((floor - Vec3(0, 0, 20)).norm() <= 1e-8);
}
