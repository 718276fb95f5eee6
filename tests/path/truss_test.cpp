// The two-bar truss: limit points, and the branch points of a tall one, on all of its path.
#include "catch.hpp"
#include "path/tracing.hpp"
#include "reference.hpp"

#include <cmath>

using namespace elamin;

namespace {

double number(const nlohmann::json& x) { return x.get<double>(); }

// Pins at (−b, 0) and (b, 0), the apex between at height y; a load of 1 down on it at load factor 1.
Model truss(const nlohmann::json& c, double y) {
  const double b = number(c["b"]), q0 = number(c["q0"]);
  Model m;
  m.start.position = Field::Zero(3, 3), m.start.low = Field::Zero(3, 3);
  m.start.position(0, 0) = -b, m.start.position(1, 1) = y, m.start.position(0, 2) = b;
  m.bond_types = {{number(c["K"]), q0}};
  m.bonds = {{0, {0, 1}}, {0, {1, 2}}};
  if (number(c["B"]) > 0) m.angle_types = {{number(c["B"])}}, m.angles = {{0, {0, 1, 2}}};
  m.diameter.assign(3, b), m.density.assign(3, 1), m.id = {1, 2, 3}, m.type.assign(3, 1), m.molecule.assign(3, 1);
  m.structures = {{"truss", "beam", 0, 3, 0, 0, 0}};
  Support pins;
  pins.particles = {0, 2};
  m.supports = {pins};
  Load load;
  load.particles = {1}, load.force = Vec3(0, -1, 0);
  m.loads = {load};
  m.plane_normal = 2;
  return m;
}

}  // namespace

TEST_CASE("the path of a two-bar truss goes through its limit points and over its branch points", "[path]") {
  const nlohmann::json cases = reference("exact/truss.json")["cases"];
  const int steps = GENERATE(10, 100, 1000);
  for (const nlohmann::json& c : cases) {
    const double top = number(c["limit_points"][0]["P"]);
    const Model model = truss(c, number(c["zero_load_equilibria"][0]["y"]));
    CAPTURE(steps, top);
    Energy energy(model);
    Newton newton(energy);
    const Trace t = trace(newton, model.start, arcs(1.5 * top, steps));
    CAPTURE(t.why, t.points.size());
    REQUIRE(t.status == Status::converged);
    CHECK(t.points.back().state.load_factor == Approx(1.5 * top));
    for (const char* kind : {"limit", "branch"}) {
      const nlohmann::json expected = c[kind == std::string("limit") ? "limit_points" : "sway_branch_points"];
      const std::vector<PathPoint> found = t.labelled(kind);
      REQUIRE(found.size() == expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        CHECK(found[k].state.load_factor == Approx(number(expected[k]["P"])).epsilon(1e-9));
        CHECK(found[k].state.position(1, 1) == Approx(number(expected[k]["y"])).epsilon(1e-8));
        CHECK(found[k].multiplicity == 1);
      }
    }
    // Every row of the reference path that lies between two points has their index.
    int told = 0;
    for (const nlohmann::json& row : c["path"]) {
      const double y = number(row["y"]);
      for (std::size_t k = 0; k + 1 < t.points.size(); ++k) {
        const double a = t.points[k].state.position(1, 1), b = t.points[k + 1].state.position(1, 1);
        if (!(y < a && y > b) || t.points[k].label.size() > 0 || t.points[k + 1].label.size() > 0) continue;
        if (t.points[k].stability.negative != t.points[k + 1].stability.negative) continue;
        CHECK(t.points[k].stability.negative == row["index_load_control"].get<int>());
        CHECK(t.points[k].stability.negative_rigid == row["index_displacement_control"].get<int>());
        ++told;
      }
    }
    CHECK(told > 2);
  }
}

// With E = Σ K (r − q)² it sways where r³ − q r² + q b² = 0: at a double root r = √3 b for q = 3√3/2 b, and at two beside it where q is a little larger.
TEST_CASE("two branch points next to each other are found whatever the steps are", "[path]") {
  const int steps = GENERATE(3, 4, 10, 30, 100);
  const double more = GENERATE(-1e-3, 1e-2, 1e-3, 1e-4, 1e-5);
  const double b = 1, K = 1, q = 1.5 * std::sqrt(3.0) * b * (1 + more);
  const auto sways = [&](double r) { return r * r * (r - q) + q * b * b; };
  const auto load = [&](double r) { return 4 * K * std::sqrt(r * r - b * b) * (q / r - 1); };
  const auto root = [&](double from, double to) {
    for (int k = 0; k < 200; ++k) {
      const double r = (from + to) / 2;
      ((sways(r) < 0) == (sways(from) < 0) ? from : to) = r;
    }
    return from;
  };
  const double limit = std::cbrt(q * b * b), least = 2 * q / 3;
  std::vector<double> down{load(limit)};
  if (sways(least) < 0) down = {load(root(q, least)), load(root(b, least)), load(limit)};
  const Model model = truss({{"b", b}, {"q0", q}, {"K", K}, {"B", 0.0}}, std::sqrt(q * q - b * b));
  Energy energy(model);
  Newton newton(energy);
  const Trace t = trace(newton, model.start, arcs(1.5 * load(limit), steps));
  CAPTURE(steps, more, t.why, t.points.size());
  REQUIRE(t.status == Status::converged);
  std::vector<double> found;
  for (const PathPoint& p : t.points)
    if (p.label.starts_with("limit:") || p.label.starts_with("branch:")) found.push_back(p.state.load_factor);
  REQUIRE(found.size() == 2 * down.size());
  for (std::size_t k = 0; k < down.size(); ++k) {
    CHECK(found[k] == Approx(down[k]).epsilon(1e-9));
    CHECK(found[found.size() - 1 - k] == Approx(-down[k]).epsilon(1e-9));
  }
}
