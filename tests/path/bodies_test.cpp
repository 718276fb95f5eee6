// Equilibrium paths of rigid bodies, each with a closed form. Contacts that open change the stiffness at once: corners.
#include "solve/bodies.hpp"

#include "catch.hpp"
#include "laws/rounded/rotation.hpp"
#include "path/tracing.hpp"

using namespace elamin;

namespace {

double tilt(const State& s) { return rotation_between(Eigen::Quaterniond::Identity(), s.bodies[0].rotation)[1]; }

// A box on a floor, its centre held against sliding, pushed at a height a above its centre by a dead force; it turns about y. Core
// 2b × · × 2c, floor k_n at two vertices in front and two behind.
//   both touch:        F a = 4 k b² sin θ − W c tan θ                  up to sin θ = W/(4 k b)
//   those in front:    F a = W (b − c tan θ)
struct Tipping {
  double b = 0.5, c = 0.8, a = 0.7, k = 20, W = 1;
  double last = std::asin(W / (4 * k * b));
  double limit() const { return W * (b - c * std::tan(last)) / a; }
  double force(double theta) const {
    if (theta < last) return (4 * k * b * b * std::sin(theta) - W * c * std::tan(theta)) / a;
    return W * (b - c * std::tan(theta)) / a;
  }
  Model model(double largest) const {
    Model m;
    const double rho = 0.1;
    add_body(m, box_core(Vec3(2 * b, 0.6, 2 * c)), rho, pose(Vec3(0, 0, c + rho - W / (4 * k))), W);
    add_plane(m, Vec3::Zero(), Vec3::UnitZ(), k);
    add_weight(m, Vec3(0, 0, -1));
    hold_bodies(m, {0}, {true, true, false}, {true, false, true});
    pull(m, 0, Vec3(largest, 0, 0), Vec3(0, 0, a));
    return m;
  }
};

}  // namespace

TEST_CASE("a box tips where the force on its top is largest", "[path][bodies]") {
  const Tipping t;
  const double most = 1.25 * t.limit();
  const Model m = t.model(most);
  Energy energy(m);
  REQUIRE(energy.dofs() == 2);
  Newton newton(energy);
  PathOptions options;
  options.to = 1, options.steps = GENERATE(7, 40), options.when_unstable = WhenUnstable::stop;
  options.method = GENERATE(PathMethod::load_steps, PathMethod::arc_length);
  const Trace trace = elamin::trace(newton, m.start, options);
  INFO(trace.why);
  for (const PathPoint& p : trace.points) INFO(p.state.load_factor << " " << tilt(p.state) << " " << p.label << " " << p.what);
  REQUIRE(trace.labelled("limit").size() == 1);
  const PathPoint p = trace.labelled("limit").front();
  CHECK(std::abs(p.state.load_factor * most - t.limit()) <= 1e-9 * t.limit());
  CHECK(std::abs(tilt(p.state) - t.last) <= 1e-9);
  CHECK(p.negative_before == 0);
  CHECK(p.negative_after == 1);
  CHECK(p.what.find("leaves wall floor") != std::string::npos);
  CHECK(trace.status == Status::converged);
}

TEST_CASE("behind the limit the box stands on its edge, unstable", "[path][bodies]") {
  const Tipping t;
  const double most = 1.25 * t.limit();
  const Model m = t.model(most);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options = arcs(1, 40);
  options.lowest = 0;
  const Trace trace = elamin::trace(newton, m.start, options);
  INFO(trace.why);
  REQUIRE(trace.points.size() > 10);
  double farthest = 0;
  for (const PathPoint& p : trace.points) {
    const double theta = tilt(p.state);
    farthest = std::max(farthest, theta);
    INFO(theta << " " << p.label);
    CHECK(std::abs(p.state.load_factor * most - t.force(theta)) <= 1e-9 * t.limit());
    if (p.label.empty()) CHECK(p.stability.negative == (theta > t.last ? 1 : 0));
  }
  // It ends where the weight is over the edge.
  CHECK(std::abs(farthest - std::atan(t.b / t.c)) <= 1e-9);
  CHECK(trace.labelled("limit").size() == 1);
}

// A small cube sticks to a large one with four contacts, each coded: force 4 (k_n δ + s) for δ ≤ 0, 4 (s − k_na δ) beyond,
// s = k_na r_c. Pulled off at F = 4 s, δ = 0.
TEST_CASE("a cube sticks to another until the force pulls it off", "[path][bodies]") {
  const double k = 500, ka = GENERATE(80.0, 900.0), rc = 0.04, s = ka * rc, size = 1.2, most = 5 * s;
  Model m;
  add_body(m, box_core(Vec3(2, 2, 1)), 0.1, pose(Vec3::Zero()));
  add_body(m, cube_core(1), 0.1, pose(Vec3(0.1, -0.05, size - s / k)));
  add_contacts(m, {k, ka, rc, RoundedKernel::Form::coded});
  hold_bodies(m, {0}, {true, true, true}, {true, true, true});
  hold_bodies(m, {1}, {true, true, false}, {true, true, true});
  pull(m, 1, Vec3(0, 0, most));
  Energy energy(m);
  Newton newton(energy);
  const auto gap = [&](const State& state) { return place(state, 1)[2] - size; };
  SECTION("stop") {
    PathOptions options;
    options.to = 1, options.steps = 13, options.when_unstable = WhenUnstable::stop;
    options.method = GENERATE(PathMethod::load_steps, PathMethod::arc_length);
    const Trace trace = elamin::trace(newton, m.start, options);
    INFO(trace.why);
    REQUIRE(trace.labelled("limit").size() == 1);
    const PathPoint p = trace.labelled("limit").front();
    CHECK(std::abs(p.state.load_factor * most - 4 * s) <= 1e-9 * s);
    CHECK(std::abs(gap(p.state)) <= 1e-9 * rc);
    CHECK(p.negative_after == 1);
  }
  SECTION("follow") {
    PathOptions options = arcs(1, 20);
    options.lowest = 0;
    const Trace trace = elamin::trace(newton, m.start, options);
    INFO(trace.why);
    double widest = -1;
    for (const PathPoint& p : trace.points) {
      const double d = gap(p.state);
      widest = std::max(widest, d);
      CHECK(std::abs(p.state.load_factor * most - 4 * (d <= 0 ? k * d + s : s - ka * d)) <= 1e-9 * s);
    }
    CHECK(widest > 0.9 * rc);
    CHECK(trace.labelled("limit").size() == 1);
  }
}

// Three cubes between walls, the gaps between them open: one spring after the other.
TEST_CASE("gaps that close one after the other make a bent path", "[path][bodies]") {
  const double k = 30, size = 1.2, gap = 0.01;
  Model m;
  add_body(m, cube_core(1), 0.1, pose(Vec3(0, 0, 0)));
  add_body(m, cube_core(1), 0.1, pose(Vec3(size + gap, 0, 0)));
  add_body(m, cube_core(1), 0.1, pose(Vec3(2 * size + 3 * gap, 0, 0)));
  add_contacts(m, {k, 0, 0, RoundedKernel::Form::coded});
  // Each on a soft cohesive wall of its own side keeps it from floating: springs of four vertices.
  Wall& left = add_plane(m, Vec3(-0.6, 0, 0), Vec3::UnitX(), k, "left");
  left.bodies = {0};
  hold_bodies(m, {0, 1}, {false, true, true}, {true, true, true});
  hold_bodies(m, {2}, {true, true, true}, {true, true, true});
  m.supports.back().displacement = Vec3(-0.1, 0, 0);
  // The one in the middle is tied to nothing before it is met: a weak weight leans it on the last one.
  Gravity g;
  g.bodies = {0, 1}, g.acceleration = Vec3(-0.02, 0, 0);
  m.gravity.push_back(g);
  m.start.bodies[1].position.hi[0] = size - 0.02 / (4 * k) - 0.04 / (4 * k);
  m.start.bodies[0].position.hi[0] = -0.04 / (4 * k);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.to = 1, options.steps = 10;
  options.method = GENERATE(PathMethod::load_steps, PathMethod::arc_length);
  const Trace trace = elamin::trace(newton, m.start, options);
  INFO(trace.why);
  REQUIRE(trace.status == Status::converged);
  REQUIRE(trace.labelled("contact").size() == 1);
  const PathPoint met = trace.labelled("contact").front();
  const double at = 3 * gap + 0.02 / (4 * k) + 0.04 / (4 * k);
  CHECK(std::abs(0.1 * met.state.load_factor - at) <= 1e-9);
  CHECK(met.what == "body 2 touches body 3");
  const State& last = trace.points.back().state;
  const double force = (0.1 - at) * 4 * k / 3;
  CHECK(std::abs(-place(last, 0)[0] - (force + 0.04) / (4 * k)) <= 1e-9);
}
