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
