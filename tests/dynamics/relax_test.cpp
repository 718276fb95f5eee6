// FIRE against Newton: the same minimum.
#include "catch.hpp"
#include "chain.hpp"
#include "dynamics/relax.hpp"
#include "model/grains.hpp"
#include "plate.hpp"
#include "solve/newton.hpp"

using namespace elamin;

namespace {

void same_minimum(const Model& m, double tolerance = 1e-10) {
  Energy energy(m);
  State found = m.start, newton = m.start;
  const Report report = relax(energy, found, {.tolerance = tolerance});
  INFO(report.why);
  REQUIRE(report.converged());
  CHECK(report.residual <= tolerance);
  newton = found;
  const Report polished = Newton(energy).minimise(newton);
  INFO(polished.why);
  REQUIRE(polished.converged());
  CHECK(report.energy == Approx(polished.energy).epsilon(1e-12).margin(1e-15));
  CHECK(displacement(found, newton).cwiseAbs().maxCoeff() < 1e-5 * m.diameter[0]);
  for (const Support& s : m.supports)
    for (const int p : s.particles)
      for (int c = 0; c < 3; ++c)
        if (s.held[c]) CHECK(found.position(c, p) == m.start.position(c, p));
}

}  // namespace

TEST_CASE("relax bends a cantilever to Newton's equilibrium", "[dynamics][relax]") {
  Model m = chain(12, 100, 20, 1);
  hold(m, 0, 1);
  m.loads.push_back({"", {11}, {0.2, 0, 0}, Scaling::constant()});
  same_minimum(m);
  Energy energy(m);
  State fire = m.start, newton = m.start;
  REQUIRE(relax(energy, fire).converged());
  REQUIRE(Newton(energy).minimise(newton).converged());
  CHECK(displacement(fire, newton).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("relax converges on a slender column that buckled", "[dynamics][relax]") {
  Model m = chain(40, 1e4, 1, 1);
  hold(m, 0, 1), hold(m, 38, 39);
  m.plane_normal = 1;                                         // else it may turn about its axis
  for (int p = 0; p < 40; ++p) {
    m.start.position(2, p) *= 0.99;
    if (p > 1 && p < 38) m.start.position(0, p) = 0.5 * std::sin(pi * (p - 1) / 37.0);
  }
  m.start.low.setZero();
  same_minimum(m);
}

TEST_CASE("relax settles a loaded sheet and grains on a floor", "[dynamics][relax]") {
  Plate p = plate(7, 6, true, 1, 100, 10);
  p.hold(p.edge("clamped"), [](const Vec3&) { return Vec3::Zero().eval(); });
  std::vector<int> all(p.model.particles());
  for (int i = 0; i < p.model.particles(); ++i) all[i] = i;
  p.model.loads.push_back({"", all, {0, 0, 0.3}, Scaling::constant()});
  same_minimum(p.model);

  Model m;
  m.start = State(Field(3, 4));
  m.start.position << 0.6, 1.4, 1.0, 1.0,  0.6, 0.6, 1.4, 0.9,  0.7, 0.7, 0.7, 1.6;   // three below, one above
  m.diameter = {1, 1, 1, 1}, m.density = {1, 1, 1, 1}, m.id = {1, 2, 3, 4}, m.type = {1, 1, 1, 1}, m.molecule = {1, 2, 3, 4};
  PairContact c;
  c.between = {"all", "all"}, c.particles = {std::vector<int>{0, 1, 2, 3}, std::vector<int>{0, 1, 2, 3}}, c.effective_modulus = 1000;
  m.contacts = {c};
  Wall w;
  w.name = "box", w.particles = {0, 1, 2, 3}, w.effective_modulus = 1000;
  w.region.shape = Shape::block, w.region.lo = Vec3::Zero(), w.region.hi = Vec3(1.9, 1.9, 4);
  m.walls = {w};
  m.gravity.push_back({"", {0, 1, 2, 3}, {0, 0, -5}, Scaling::constant()});
  Energy energy(m);
  State state = m.start;
  const Report report = relax(energy, state);
  INFO(report.why);
  CHECK(report.converged());
  CHECK(state.position.row(2).minCoeff() > 0);
}

TEST_CASE("relax says when it may take no more steps", "[dynamics][relax]") {
  Model m = chain(12, 100, 20, 1);
  hold(m, 0, 1);
  m.loads.push_back({"", {11}, {0.2, 0, 0}, Scaling::constant()});
  Energy energy(m);
  State state = m.start;
  const Report report = relax(energy, state, {.max_steps = 10});
  CHECK(report.status == Status::not_converged);
  CHECK(report.iterations == 10);
  CHECK(report.why.find("after 10 steps") != std::string::npos);
}

TEST_CASE("relax says what moves away without end, long before its last step", "[dynamics][relax]") {
  Model m;
  Field x = Field::Zero(3, 2);
  x(0, 1) = 2;
  add_grains(m, {{"grains", x, {1, 1}, 1}});
  PairContact contact;
  contact.particles = {numbers(2), numbers(2)}, contact.effective_modulus = 100;
  m.contacts.push_back(contact);
  hold(m, 0, 0);
  weigh(m, 1);
  Energy energy(m);
  State state = m.start;
  const Report report = relax(energy, state);
  CHECK(report.status == Status::not_converged);
  CHECK(report.iterations < 10'000);                             // 100 extents of 3 or so, a twentieth of a diameter each
  CHECK(report.why.find("grains 2 moves away without end") != std::string::npos);
}

TEST_CASE("a heap of bodies comes to rest", "[dynamics][bodies]") {
  Model m;
  m.start = State(Field(3, 0));
  const auto add = [&m](const CoreMesh& core, const Vec3& x, const Vec3& turned) {
    m.shapes.push_back(rounded_shape(core, 0.1));
    const int b = static_cast<int>(m.bodies.size());
    m.bodies.push_back({b, b + 1, 1, 1.0, Mat3::Identity()});
    m.start.bodies.push_back({{x, Vec3::Zero()}, quaternion(turned)});
  };
  add(cube_core(0.8), Vec3(0, 0, 0.55), Vec3(0.05, -0.04, 0.1));
  add(box_core(Vec3(0.7, 0.7, 0.5)), Vec3(0.05, 0.02, 1.4), Vec3(-0.03, 0.02, 0.5));
  RoundedPair t;
  t.bodies = {std::vector{0, 1}, std::vector{0, 1}}, t.kernel.normal = 200;
  m.rounded = {t};
  Wall floor;
  floor.region.shape = Shape::plane, floor.bodies = {0, 1}, floor.kernel.normal = 200;
  m.walls = {floor};
  Gravity g;
  g.bodies = {0, 1}, g.acceleration = Vec3(0, 0, -1);
  m.gravity = {g};
  Support above;                                             // nothing rubs: they would slide apart
  above.bodies = {0, 1}, above.held = {true, true, false};
  m.supports = {above};
  Energy energy(m);
  State state = m.start;
  RelaxOptions options;
  options.tolerance = 1e-9, options.max_steps = 200000;
  const Report report = relax(energy, state, options);
  INFO(report.why);
  CHECK(report.status == Status::converged);
  // The lower one bears both on four corners.
  CHECK(state.bodies[0].position.hi.z() == Approx(0.5 - 2.0 / (4 * 200)).epsilon(1e-7));
  CHECK(energy.last_terms().body > 0);
  // The upper one's weight stands aside by (0.05, 0.02): the lower one tilts by m g d/(k Σ x²).
  const double tilt = std::hypot(0.05, 0.02) / (4 * 200 * 0.4 * 0.4);
  CHECK(1 - (state.bodies[0].rotation * Vec3::UnitZ()).z() == Approx(tilt * tilt / 2).epsilon(1e-2));
}
