// Branch points and what leaves them, whatever the length of the steps.
#include "catch.hpp"
#include "chain.hpp"
#include "path/tracing.hpp"
#include "reference.hpp"

#include <cmath>
#include <set>

using namespace elamin;

namespace {

// Clamped as in the validation: pairs held at both ends, the upper one driven by the end shortening at load factor 1.
Model clamped(const nlohmann::json& c, bool plane, double shortening) {
  const int n = static_cast<int>(c["N_free_particles"]) + 4;
  Model m = chain(n, c["K"], c["B"], c["q0"]);
  hold(m, 0, 1), hold(m, n - 2, n - 1, {true, true, true}, Vec3(0, 0, -shortening));
  if (plane) m.plane_normal = 1;
  return m;
}

std::set<int> branches_of(const Trace& t) {
  std::set<int> all;
  for (const PathPoint& p : t.points) all.insert(p.branch);
  return all;
}

}  // namespace

TEST_CASE("both halves of a pitchfork are found for any length of step, no event twice", "[path][reference]") {
  const nlohmann::json c = reference("exact/post_buckling_clamped.json")["cases"][0];
  const int steps = GENERATE(10, 100, 1000);
  const double critical = c["critical_end_shortening"];
  const nlohmann::json& s = c["states"][0];
  const double end = s["end_shortening"];
  const Model model = clamped(c, true, end);
  Energy energy(model);
  Newton newton(energy);
  PathOptions options = arcs(1, steps);
  options.branches = 1, options.when_unstable = WhenUnstable::stop;
  const Trace t = trace(newton, model.start, options);
  CAPTURE(steps, t.why, t.notes, t.points.size());
  REQUIRE(t.status == Status::converged);
  REQUIRE(t.labels() == std::vector<std::string>{"initial", "branch:1"});
  const PathPoint branch_point = t.labelled("branch")[0];
  CHECK(branch_point.state.load_factor * end == Approx(critical).epsilon(1e-10));
  CHECK(branch_point.multiplicity == 1);
  CHECK(branch_point.negative_before == 0);
  CHECK(branch_point.negative_after == 1);
  REQUIRE(branches_of(t) == std::set<int>{0, 1, 2});
  const int middle = model.particles() / 2;
  double product = 1;
  for (const int half : {1, 2}) {
    const PathPoint* last = nullptr;
    for (const PathPoint& p : t.points)
      if (p.branch == half) {
        last = &p;
        CHECK(p.stability.stable);
        CHECK(p.parent == "branch:1");
      }
    REQUIRE(last->state.load_factor == 1);
    double most = 0;
    for (int i = 0; i < model.particles(); ++i)
      if (std::abs(last->state.position(0, i)) > std::abs(most)) most = last->state.position(0, i);
    CHECK(std::abs(most) == Approx(s["max_deflection"].get<double>()).epsilon(1e-10));
    CHECK(last->energy.total() == Approx(s["U_total"].get<double>()).epsilon(1e-11));
    product *= last->state.position(0, middle);
  }
  CHECK(product < 0);                                          // to either side
}

TEST_CASE("a column in space buckles at a double branch point, of the circle of branches one is traced", "[path][reference]") {
  const nlohmann::json c = reference("exact/post_buckling_clamped.json")["cases"][0];
  const nlohmann::json& s = c["states"][0];
  const double end = s["end_shortening"];
  const Model model = clamped(c, false, end);
  Energy energy(model);
  Newton newton(energy);
  PathOptions options = arcs(1, 20);
  options.branches = 1, options.when_unstable = WhenUnstable::stop;
  const Trace t = trace(newton, model.start, options);
  CAPTURE(t.why, t.notes, t.points.size());
  REQUIRE(t.status == Status::converged);
  const std::vector<PathPoint> found = t.labelled("branch");
  REQUIRE(found.size() == 1);
  CHECK(found[0].multiplicity == 2);
  CHECK(found[0].negative_after == 2);
  CHECK(found[0].state.load_factor * end == Approx(c["critical_end_shortening"].get<double>()).epsilon(1e-10));
  REQUIRE(branches_of(t) == std::set<int>{0, 1, 2});
  for (const PathPoint& p : t.points) {
    if (p.branch == 0) continue;
    CHECK(p.stability.stable);
    CHECK(p.stability.zero == 1);                              // the plane of buckling turns at no cost
    CHECK(p.stability.zero_modes.size() == 1);
  }
  CHECK(t.points.back().energy.total() == Approx(s["U_total"].get<double>()).epsilon(1e-11));
}

namespace {

// Two bars of length 1 that rest with their joint at the height h, or at -h; a force pulls it down.
Model two_bars(double h, double force) {
  Model m = chain(3, 1, 0, 1);
  m.angles.clear(), m.angle_types.clear();
  const double b = std::sqrt(1 - h * h);
  m.start.position = Field::Zero(3, 3);
  m.start.position(0, 0) = -b, m.start.position(1, 1) = h, m.start.position(0, 2) = b;
  m.start.low.setZero();
  m.plane_normal = 2;
  hold(m, 0, 0), hold(m, 2, 2);
  Load load;
  load.particles = {1}, load.force = Vec3(0, -force, 0);
  m.loads = {load};
  return m;
}

}  // namespace

TEST_CASE("deflation finds the states that the branch does not reach", "[path]") {
  // Without load the truss rests up and down, and flat in unstable equilibrium.
  const double h = 0.3, b = std::sqrt(1 - h * h);
  const Model m = two_bars(h, 1);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.to = 0.001, options.steps = 2, options.deflate = 4, options.deflate_at.push_back(0);
  const Trace t = trace(newton, m.start, options);
  CAPTURE(t.why, t.notes);
  const std::vector<PathPoint> found = t.labelled("deflated");
  std::multiset<int> heights;
  for (const PathPoint& p : found) {
    CHECK(p.state.load_factor == 0);
    CHECK(p.report.residual < 1e-12);
    const double y = p.state.position(1, 1);
    if (std::abs(p.state.position(0, 1)) > 0.1 * b) continue;
    heights.insert(std::abs(y) < 1e-9 ? 0 : y > 0 ? 1 : -1);
    CHECK(p.stability.negative == (std::abs(y) < 1e-9 ? 1 : 0));
    CHECK(std::min(std::abs(y), std::abs(std::abs(y) - h)) < 1e-12);
  }
  CHECK(heights == std::multiset<int>{-1, 0});
}

TEST_CASE("the end of a path says that a lower minimum is known", "[path]") {
  // Of the two wells of the truss the one that the force points to is the lower one; without force they are as low as each other.
  const auto [force, is_lowest] = GENERATE(std::pair{1.0, false}, std::pair{-1.0, true});
  const Model m = two_bars(0.3, force);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.to = 0.001, options.steps = 2, options.deflate = 4, options.deflate_at = {0, 0.0007, 0.001};
  const Trace t = trace(newton, m.start, options);
  CAPTURE(t.why, t.notes);
  REQUIRE(t.status == Status::converged);
  int below = 0;
  for (const PathPoint& p : t.labelled("deflated")) below += p.state.position(1, 1) < -0.29;
  CHECK(below >= 3);
  const auto told = [&](const std::string& at) { return t.why.find("at load factor " + at + " its minimum is not the lowest") != std::string::npos; };
  CHECK(!told("0"));
  CHECK(told("0.0007") == !is_lowest);
  CHECK(told("0.001") == !is_lowest);
}

TEST_CASE("a watch is located and may end the path", "[path]") {
  Model m = chain(14, 1, 0.05, 1);
  m.plane_normal = 1;
  hold(m, 0, 1), hold(m, 12, 13, {true, true, true}, Vec3(0, 0, -2));
  Energy energy(m);
  Newton newton(energy);
  for (const PathMethod method : {PathMethod::load_steps, PathMethod::arc_length}) {
    PathOptions options;
    options.method = method, options.steps = 20;
    const double top = 13 - 2 * 0.4;
    options.user_events = {{"end", [](const State& s) { return s.position(2, 13); }, top, false},
                       {"half", [](const State& s) { return s.position(2, 13); }, 12, true}};
    const Trace t = trace(newton, m.start, options);
    CAPTURE(t.why, t.notes);
    CHECK(t.status == Status::converged);
    REQUIRE(t.labelled("end").size() == 1);
    CHECK(t.labelled("end")[0].state.load_factor == Approx(0.4).epsilon(1e-12));
    REQUIRE(t.labelled("half").size() == 1);
    CHECK(t.points.back().label == "half:1");
    CHECK(t.points.back().state.load_factor == Approx(0.5).epsilon(1e-12));
  }
}

TEST_CASE("a column that is all but perfect bends to the side that it is pushed to", "[path]") {
  const nlohmann::json c = reference("exact/post_buckling_clamped.json")["cases"][0];
  const int steps = GENERATE(10, 50, 137);
  const double part = GENERATE(1e-4, 1e-6, 1e-7);              // of the end force at buckling, to the side
  const PathMethod method = GENERATE(PathMethod::load_steps, PathMethod::arc_length);
  const nlohmann::json& s = c["states"][0];
  Model model = clamped(c, true, s["end_shortening"]);
  const int middle = model.particles() / 2;
  Load nudge;
  nudge.particles = {middle}, nudge.force = Vec3(part * s["end_force_compressive"].get<double>(), 0, 0);
  nudge.scaling = Scaling::constant();
  model.loads = {nudge};
  Energy energy(model);
  Newton newton(energy);
  PathOptions options = arcs(1, steps);
  options.method = method;
  const Trace t = trace(newton, model.start, options);
  CAPTURE(steps, part, method == PathMethod::arc_length, t.why, t.points.size());
  CHECK(t.status == Status::converged);
  CHECK(t.labels() == std::vector<std::string>{"initial"});
  const PathPoint& last = t.points.back();
  CHECK(last.state.load_factor == 1);
  CHECK(last.state.position(0, middle) > 0.9 * s["mid_deflection"].get<double>());
}
