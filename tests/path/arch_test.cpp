// Clamped arches under a load on their middle: limit points, branch points, the path that joins these.
#include "catch.hpp"
#include "path/tracing.hpp"
#include "reference.hpp"

#include <cmath>
#include <numbers>

using namespace elamin;

namespace {

// Bonds of the rest length in these directions (angles to x) from the origin on, two particles held at each end; a load of 1 down
// on the middle one at load factor 1.
Model arch(const nlohmann::json& c, const std::vector<double>& slopes, const Vec3& shortening) {
  const double q0 = c["q0"];
  const int n = static_cast<int>(slopes.size()) + 1;
  Model m;
  m.start.position = Field::Zero(3, n), m.start.low = Field::Zero(3, n);
  for (int i = 0; i + 1 < n; ++i) m.start.position.col(i + 1) = m.start.position.col(i) + q0 * Vec3(std::cos(slopes[i]), std::sin(slopes[i]), 0);
  m.bond_types = {{c["K"], q0}}, m.angle_types = {{c["B"]}};
  for (int i = 0; i + 1 < n; ++i) m.bonds.push_back({0, {i, i + 1}});
  for (int i = 0; i + 2 < n; ++i) m.angles.push_back({0, {i, i + 1, i + 2}});
  m.diameter.assign(n, q0), m.density.assign(n, 1), m.type.assign(n, 1), m.molecule.assign(n, 1);
  for (int i = 0; i < n; ++i) m.id.push_back(i + 1);
  m.structures = {{"arch", "beam", 0, n, 0, 0, 0}};
  Support left, right;
  left.particles = {0, 1};
  right.particles = {n - 2, n - 1}, right.displacement = shortening, right.scaling = {1, 0};
  m.supports = {left, right};
  Load load;
  load.particles = {n / 2}, load.force = Vec3(0, -1, 0);
  m.loads = {load};
  m.plane_normal = 2;
  return m;
}

// Of the reference's rows those that lie between two points of the trace with one index: it must be theirs.
int check_indices(const Trace& t, const nlohmann::json& rows, const std::function<double(const PathPoint&)>& deflection) {
  int told = 0;
  for (const nlohmann::json& row : rows) {
    const double w = row["w"];
    for (std::size_t k = 0; k + 1 < t.points.size(); ++k) {
      const PathPoint &a = t.points[k], &b = t.points[k + 1];
      if (!(w > deflection(a) && w < deflection(b)) || !a.label.empty() || !b.label.empty()) continue;
      if (a.stability.negative != b.stability.negative || a.stability.negative_rigid != b.stability.negative_rigid) continue;
      CHECK(a.stability.negative == row["index_load_control"].get<int>());
      CHECK(a.stability.negative_rigid == row["index_displacement_control"].get<int>());
      ++told;
    }
  }
  return told;
}

void check_events(const std::vector<PathPoint>& found, const nlohmann::json& expected, const std::function<double(const PathPoint&)>& deflection,
                  double size) {
  for (const PathPoint& p : found) {
    CHECK(p.multiplicity == 1);
    CHECK(std::abs(p.negative_after - p.negative_before) == 1);
  }
  for (const nlohmann::json& e : expected) {
    const double P = e["P"], w = e["w"];
    for (const PathPoint& p : found) UNSCOPED_INFO(p.label << " P error " << (p.state.load_factor - P) / P << " w error " << (deflection(p) - w) / size);
    CHECK(std::count_if(found.begin(), found.end(), [&](const PathPoint& p) {
      return std::abs(p.state.load_factor - P) <= 1e-9 * std::abs(P) && std::abs(deflection(p) - w) <= 1e-8 * size;
    }) == 1);
  }
}

}  // namespace

TEST_CASE("tilted clamped arches snap through two limit points", "[path][reference]") {
  const int steps = GENERATE(10, 100, 1000);
  for (const nlohmann::json& c : nlohmann::json(reference("exact/arch_clamped_tilted.json")["cases"])) {
    const int N = c["N_free_particles"], middle = c["central_particle_0based"];
    const double alpha = c["alpha"], top = c["limit_points"][0]["P"];
    std::vector<double> slopes;
    for (int i = 0; i <= N + 2; ++i) slopes.push_back(alpha - i * 2 * alpha / (N + 2));
    const Model model = arch(c, slopes, Vec3::Zero());
    CAPTURE(alpha, N, steps);
    Energy energy(model);
    Newton newton(energy);
    const Trace t = trace(newton, model.start, arcs(1.2 * top, steps));
    CAPTURE(t.why, t.points.size());
    REQUIRE(t.status == Status::converged);
    const auto deflection = [&](const PathPoint& p) { return model.start.position(1, middle) - p.state.position(1, middle); };
    CHECK(t.labels() == std::vector<std::string>{"initial", "limit:1", "limit:2"});
    check_events(t.labelled("limit"), c["limit_points"], deflection, c["rise"]);
    CHECK(check_indices(t, c["path"], deflection) > 5);
  }
}

TEST_CASE("a buckled arch flips through limit points and branch points, and along the path between them", "[path][reference]") {
  const int steps = GENERATE(10, 100, 1000);
  for (const nlohmann::json& c : nlohmann::json(reference("exact/arch_buckled_clamped.json")["cases"])) {
    const int N = c["N_free_particles"], middle = c["central_particle_0based"];
    const double rise = c["rise"], top = c["limit_points"][0]["P"];
    const Model model = arch(c, std::vector<double>(N + 3, 0.0), Vec3(-c["end_shortening"].get<double>(), 0, 0));
    CAPTURE(N, steps, c["factor"].get<double>());
    Energy energy(model);
    Newton newton(energy);
    State start = model.start;
    energy.kinematics().prescribe(start, 0);
    for (int p = 2; p < N + 2; ++p) start.position(1, p) = rise / 2 * (1 - std::cos(2 * std::numbers::pi * (p - 0.5) / (N + 2)));
    REQUIRE(newton.minimise(start).converged());
    const double high = start.position(1, middle);
    CHECK(high == Approx(rise).epsilon(1e-9));
    const auto deflection = [&](const PathPoint& p) { return high - p.state.position(1, middle); };
    PathOptions options = arcs(1.2 * top, steps);
    options.branches = 2;
    const Trace t = trace(newton, start, options);
    CAPTURE(t.why, t.points.size(), t.notes);
    REQUIRE(t.status == Status::converged);
    // The symmetric path first.
    Trace first = t;
    std::erase_if(first.points, [](const PathPoint& p) { return p.branch > 0; });
    // At four times the critical shortening the third mode is near: the path turns twice more next to the flat state.
    CHECK(first.labelled("limit").size() == (c["factor"].get<double>() < 4 ? 2 : 4));
    CHECK(first.labelled("branch").size() == 2);
    check_events(first.labelled("limit"), c["limit_points"], deflection, rise);
    check_events(first.labelled("branch"), c["branch_points"], deflection, rise);
    CHECK(check_indices(first, c["path"], deflection) > 5);
    // Two halves leave the first branch point; each ends at the second, from which nothing new leaves. No event twice.
    CHECK(t.labelled("branch").size() == 2);
    CHECK(t.points.back().branch == 2);
    for (const int half : {1, 2}) {
      std::vector<PathPoint> side;
      for (const PathPoint& p : t.points)
        if (p.branch == half) side.push_back(p);
      REQUIRE(side.size() > 4);
      CHECK(side.front().parent == "branch:1");
      CHECK(side.back().state.load_factor == Approx(c["branch_points"][1]["P"].get<double>()).epsilon(1e-9));
      CHECK(std::abs(deflection(side.back()) - c["branch_points"][1]["w"].get<double>()) <= 1e-8 * rise);
    }
  }
}
