#include "catch.hpp"
#include "hard_contacts.hpp"
#include "laws/check_law.hpp"
#include "path/path.hpp"
#include "solve/contact_equilibrium.hpp"

using namespace elamin;

TEST_CASE("a hard plane lifts a beam along a path", "[path][hard]") {
  const int n = 20;
  Model m = chain(n, round_bond, round_angle, 1, Vec3::UnitX());
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
  Model m = chain(n, round_bond, round_angle, 1);
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

namespace {

struct Seen {
  double load;
  std::string label, what;
};

// What happens on a path; `state`: where it begins, then where it ends.
std::vector<Seen> events_of(const Model& model, State& state, PathOptions options) {
  Energy energy(model);
  Newton newton(energy);
  const auto path = make_path(newton, state, options);
  std::vector<Seen> seen;
  while (const auto point = path->next()) {
    if (point->label.find(':') != std::string::npos) seen.push_back({point->state.load_factor, point->label, point->what});
    check_contacts(energy, point->state);
    state = point->state;
  }
  INFO(path->why());
  REQUIRE(path->status() == Status::converged);
  CHECK(state.load_factor == options.to);
  return seen;
}

// Springs that stand beside each other, each with a grain on top, and a lid that meets grain k at the load factor `at[k]`.
Model springs_under_lid(const std::vector<double>& at, double size, double stiffness) {
  const int n = static_cast<int>(at.size());
  Model m = chain(2 * n, stiffness, 0, size);
  m.plane_normal = 1;
  m.angles.clear(), m.bonds.clear(), m.bond_types.clear();
  const double radius = size / 8, way = size / 2;
  for (int k = 0; k < n; ++k) {
    const double height = size - at[k] * way;
    m.start.position.col(2 * k) = Vec3(2 * k * size, 0, 0), m.start.position.col(2 * k + 1) = Vec3(2 * k * size, 0, height);
    m.start.low.col(2 * k).setZero(), m.start.low.col(2 * k + 1).setZero();
    m.diameter[2 * k] = m.diameter[2 * k + 1] = 2 * radius;
    m.bond_types.push_back({stiffness, height}), m.bonds.push_back({k, {2 * k, 2 * k + 1}});
    hold(m, 2 * k, 2 * k), hold(m, 2 * k + 1, 2 * k + 1, {true, false, false});
  }
  Wall& lid = hard_plane(m, Vec3(0, 0, size + radius));
  lid.name = "lid", lid.region.normal = -Vec3::UnitZ(), lid.displacement = Vec3(0, 0, -way);
  return m;
}

}  // namespace

TEST_CASE("what a lid touches does not depend on the number of steps, their direction, sizes and stiffnesses", "[path][hard]") {
  const double size = GENERATE(1e-6, 1.0, 1e3), stiffness = GENERATE(1.0, 1e11);
  const std::vector<double> at{0.5, 0.25, 0.5, 0.7, 0.5, 0.25 + 1e-6};
  const std::vector<Seen> right{{0.25, "contact:1", "chain 4"}, {0.25 + 1e-6, "contact:2", "chain 12"},
                                {0.5, "contact:3", "chain 2 VERB wall lid, chain 6 VERB wall lid, chain 10"}, {0.7, "contact:4", "chain 8"}};
  const Model m = springs_under_lid(at, size, stiffness);
  for (const int steps : {1, 6, 7, 8, 10, 11, 13, 20}) {
    INFO("size " << size << ", stiffness " << stiffness << ", " << steps << " steps");
    State state = m.start;
    PathOptions options;
    options.steps = steps;
    const auto compare = [&](const std::vector<Seen>& seen, std::vector<Seen> expected, const std::string& verb) {
      REQUIRE(seen.size() == expected.size());
      for (std::size_t k = 0; k < seen.size(); ++k) {
        CHECK(seen[k].load == Approx(expected[k].load).epsilon(1e-9));
        std::string what = expected[k].what + " VERB wall lid";
        for (std::size_t p; (p = what.find("VERB")) != std::string::npos;) what.replace(p, 4, verb);
        CHECK(seen[k].what == what);
      }
    };
    compare(events_of(m, state, options), right, "touches");
    CHECK(state.hard.size() == at.size());
    options.from = 1, options.to = 0;
    compare(events_of(m, state, options), {right.rbegin(), right.rend()}, "leaves");
    CHECK(state.hard.empty());
    // In two stages, of which the first ends where the lid touches.
    options.from = 0, options.to = 0.5;
    std::vector<Seen> seen = events_of(m, state, options);
    options.from = 0.5, options.to = 1;
    for (const Seen& s : events_of(m, state, options)) seen.push_back(s);
    compare(seen, right, "touches");
  }
}

TEST_CASE("a free ring between two hard plates is held where nothing opposes it, and flattens", "[path][hard]") {
  // At F R²/EI = 2.786408 the single line of contact becomes flat; of the chain the neighbours of the first particle touch then.
  const int n = GENERATE(40, 80), steps = GENERATE(17, 50);
  INFO(n << " particles, " << steps << " steps");
  const double chord = 2 * std::sin(pi / n), d = 0.01;
  Model m = chain(n, 1e8 / (2 * chord), 1 / chord, chord);
  m.plane_normal = 2;
  m.bonds.push_back({0, {n - 1, 0}});
  m.angles.clear(), m.angle_types.clear();
  for (int i = 0; i < n; ++i) {
    m.start.position.col(i) = Vec3(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
    m.start.low.col(i).setZero();
    m.angles.push_back({0, {(i + n - 1) % n, i, (i + 1) % n}});
  }
  m.angle_types = {{1 / chord}};
  m.angle_types[0].rest = pi - 2 * pi / n;
  m.diameter.assign(n, d);
  hold(m, n / 4, n / 4, {true, false, false}), hold(m, 3 * n / 4, 3 * n / 4, {true, false, false});
  hard_plane(m, Vec3(0, -1.005, 0)).region.normal = Vec3::UnitY();
  Wall& lid = hard_plane(m, Vec3(0, 1.006, 0));
  lid.name = "lid", lid.region.normal = -Vec3::UnitY(), lid.displacement = -Vec3::UnitY();
  State state = m.start;
  PathOptions options;
  options.steps = steps, options.to = 0.65;
  const std::vector<Seen> seen = events_of(m, state, options);
  REQUIRE(seen.size() >= 2);
  CHECK(seen[0].load == Approx(0.001).epsilon(1e-9));
  CHECK(seen[1].what.find(" touches wall lid, ") != std::string::npos);
  CHECK(seen[1].what.find(" touches wall floor") != std::string::npos);
}

TEST_CASE("a column between hard walls branches at Euler's load", "[path][hard]") {
  // P a = 4 B sin²(π/2N),  P = 2 K (q₀ − a): N links of length a, pinned at both ends.
  const int links = 10;
  const double stiff = GENERATE(1e3, 1e7), q0 = 0.1, b = 1, s = std::sin(pi / (2 * links)), k = stiff * b / (q0 * q0);
  const double a = (q0 + std::sqrt(q0 * q0 - 8 * b * s * s / k)) / 2, way = 0.05;
  Model m = chain(links + 1, k, b, q0);
  m.plane_normal = 1;
  hold(m, 0, 0), hold(m, links, links, {true, true, true}, Vec3(0, 0, -way));
  hard_plane(m, Vec3(0.1, 0, 0)).region.normal = -Vec3::UnitX();
  hard_plane(m, Vec3(-0.1, 0, 0)).region.normal = Vec3::UnitX();
  m.walls[1].name = "left";
  for (const int steps : {7, 20}) {
    State state = m.start;
    PathOptions options;
    options.steps = steps;
    const std::vector<Seen> seen = events_of(m, state, options);
    REQUIRE(seen.size() >= 3);
    CHECK(seen[0].label == "branch:1");
    CHECK(seen[0].load == Approx(links * (q0 - a) / way).epsilon(1e-9));
    CHECK(seen[1].label == "jump:1");
    CHECK(seen[2].label == "contact:1");
    CHECK(!state.hard.empty());
  }
}

TEST_CASE("a truss snaps through onto a hard stop from its limit point", "[path][hard]") {
  // F = 4 K y (ℓ₀/ℓ − 1), ℓ² = b² + y²: largest where ℓ³ = ℓ₀ b².
  const double size = GENERATE(1e-6, 1.0, 1e3), b = size, h = 0.3 * size, whole = std::hypot(b, h), k = 7;
  const double l = std::cbrt(whole * b * b), y = std::sqrt(l * l - b * b), most = 4 * k * y * (whole / l - 1);
  Model m = chain(3, k, 0, whole);
  m.plane_normal = 1;
  m.angles.clear();
  m.start.low.setZero();
  m.start.position.col(0) = Vec3(-b, 0, 0), m.start.position.col(1) = Vec3(0, 0, h), m.start.position.col(2) = Vec3(b, 0, 0);
  m.diameter.assign(3, 0.1 * size);
  hold(m, 0, 0), hold(m, 2, 2);
  m.loads.push_back({"", {1}, Vec3(0, 0, -2 * most), Scaling{}});
  hard_plane(m, Vec3(0, 0, -0.25 * size));
  for (const int steps : {6, 17, 50}) {
    INFO("size " << size << ", " << steps << " steps");
    State state = m.start;
    PathOptions options;
    options.steps = steps;
    const std::vector<Seen> seen = events_of(m, state, options);
    REQUIRE(seen.size() == 2);
    CHECK(seen[0].label == "limit:1");
    CHECK(seen[0].load == Approx(0.5).epsilon(1e-9));
    CHECK(seen[1].label == "jump:1");
    CHECK(state.position(2, 1) == Approx(-0.2 * size).epsilon(1e-12));
  }
}
