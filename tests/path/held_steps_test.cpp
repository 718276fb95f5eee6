#include "catch.hpp"
#include "hard_contacts.hpp"
#include "laws/check_law.hpp"
#include "path/path.hpp"
#include "solve/contact_equilibrium.hpp"

using namespace elamin;

namespace {

constexpr double K = pi / 8, B = pi / 64;              // a round section of unit modulus and diameter 1, on spacing 1

}  // namespace

TEST_CASE("a hard plane lifts a beam along a path", "[path][hard]") {
  const int n = 20;
  Model m = chain(n, K, B, 1, Vec3::UnitX());
  m.plane_normal = 1;
  hold(m, 0, 1), hard_plane(m, Vec3(0, 0, -1)).displacement = Vec3(0, 0, 2);
  m.walls[0].particles = {n - 2, n - 1};
  weigh(m, 1e-6);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.steps = 20;
  const auto path = make_path(newton, m.start, options);
  std::vector<PathPoint> points;
  std::size_t contact = 0;
  while (const auto point = path->next()) {
    if (point->label == "contact:1") contact = points.size();
    points.push_back(*point);
    check_contacts(energy, point->state);
    CHECK(point->report.residual <= 1e-10);
    CHECK(point->stability.stable);
  }
  INFO(path->why());
  REQUIRE(path->status() == Status::converged);
  CHECK(points.back().state.load_factor == 1);
  // The first touch is where the plane meets the beam as it hangs.
  REQUIRE(contact > 0);
  const State& first = points[contact].state;
  const double hanging = points.front().state.position(2, n - 1);
  CHECK(first.load_factor == Approx((hanging - 0.5 + 1) / 2).epsilon(1e-10));
  CHECK(first.hard.empty());
  // The plane's reaction is the derivative of the energy: dE/dλ = Σ f n·d.
  int compared = 0;
  for (std::size_t k = contact + 1; k + 1 < points.size(); ++k) {
    if (!points[k].label.empty()) continue;                      // there the energy has a kink in its second derivative
    ++compared;
    const State& at = points[k].state;
    double reaction = 0;
    for (const Touch& t : energy.touches(at)) reaction += t.force.dot(m.walls[0].displacement);
    REQUIRE(reaction > 0);
    ContactEquilibrium equilibrium(energy);
    const auto energy_at = [&](double change) {
      State s = at;
      energy.kinematics().prescribe(s, at.load_factor + change);
      REQUIRE(equilibrium.correct(s, 1e-12, &at).converged());
      return energy.value(s);
    };
    const double slope = difference(energy_at, 1e-6);
    CHECK(slope == Approx(reaction).epsilon(1e-7));
  }
  CHECK(compared >= 10);
}

TEST_CASE("a column between hard walls goes on by its contacts", "[path][hard]") {
  const int n = 40;
  Model m = chain(n, K, B, 1);
  m.plane_normal = 1;
  hold(m, 0, 1), hold(m, n - 2, n - 1, {true, true, true}, Vec3(0, 0, -0.5));
  m.loads.push_back({"", {n / 2}, Vec3(1e-5, 0, 0), Scaling::constant()});
  hard_plane(m, Vec3(2, 0, 0)).region.normal = -Vec3::UnitX();
  m.walls[0].particles.erase(m.walls[0].particles.begin(), m.walls[0].particles.begin() + 2);
  m.walls[0].particles.resize(m.walls[0].particles.size() - 2);
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.steps = 20;
  const auto path = make_path(newton, m.start, options);
  int contacts = 0;
  while (const auto point = path->next()) {
    contacts += point->label.starts_with("contact:");
    check_contacts(energy, point->state);
    CHECK(point->stability.negative == 0);
  }
  INFO(path->why());
  CHECK(path->status() == Status::converged);
  CHECK(contacts >= 1);
}
