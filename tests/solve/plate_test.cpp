#include "catch.hpp"
#include "plate.hpp"
#include "reference.hpp"
#include "solve/newton.hpp"

#include <random>

using namespace elamin;

namespace {

// What is held of each particle: nothing yet.
std::vector<std::array<bool, 3>> nothing(const Plate& p) {
  return std::vector<std::array<bool, 3>>(p.model.particles());
}

double total(const Field& forces, const std::vector<int>& particles, int coordinate) {
  double sum = 0;
  for (const int p : particles) sum += forces(coordinate, p);
  return sum;
}

}  // namespace

// Closed form: the diagonals relax, each row carries 2 K a e.
TEST_CASE("Strips pulled along their rows", "[solve][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/plate_strip_tension.json")["strip"]))
    for (const bool plane : {true, false}) {
      const double a = c["spacing"], K = c["K"], e = c["strain"];
      const int m = c["m_per_row"], n = c["n_rows"];
      INFO(n << " rows, strain " << e << (plane ? ", plane" : ", space"));
      Plate strip = plate(m, n, false, a, K, K * a * a / 6);
      auto held = nothing(strip);
      for (const auto& row : strip.rows) held[row.front()][0] = held[row.back()][0] = true;
      held[0][1] = true;
      if (plane) strip.model.plane_normal = 2;
      else
        for (const auto& row : strip.rows) held[row.front()][2] = held[row.back()][2] = true;
      strip.hold(held, [&](const Vec3& x) { return Vec3(e * x[0], 0, 0); });
      Energy energy(strip.model);
      Newton newton(energy);
      State state = strip.model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = newton.minimise(state);
      REQUIRE(report.converged());
      CHECK(report.negative == 0);
      // The places are rounded to ε of the coordinates, up to 12 a: a strain of 12 ε, of 1e-3.
      const double accuracy = 1e-12;
      double force = 0;
      const Field forces = energy.forces(state);
      for (const auto& row : strip.rows) force -= forces(0, row.back());
      CHECK(force == Approx(static_cast<double>(c["total_axial_force"])).epsilon(accuracy));
      const EnergyTerms terms = energy.terms(state);
      CHECK(terms.bond == Approx(static_cast<double>(c["U_stretch"])).epsilon(accuracy));
      CHECK(terms.angle <= 1e-12 * terms.bond);
      for (int j = 0; j < n; ++j)
        for (const int p : strip.rows[j])
          CHECK(std::abs(state.position(1, p) - j * static_cast<double>(c["row_spacing"])) <= 1e-12 * a);
    }
}

TEST_CASE("Strips pulled across their rows", "[solve][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/plate_strip_tension.json")["cross"])) {
    const double a = c["spacing"], e = c["strain"];
    const int m = c["m_per_row"], n = c["n_rows"];
    INFO(m << " a row, strain " << e);
    Plate strip = plate(m, n, false, a, c["K"], c["B"]);
    auto held = nothing(strip);
    for (const auto* row : {&strip.rows.front(), &strip.rows.back()})
      for (const int p : *row) held[p][1] = true;
    held[0][0] = true;
    strip.model.plane_normal = 2;
    strip.hold(held, [&](const Vec3& x) { return Vec3(0, e * x[1], 0); });
    Energy energy(strip.model);
    Newton newton(energy);
    State state = strip.model.start;
    energy.kinematics().prescribe(state, 1);
    REQUIRE(newton.minimise(state).converged());
    CHECK(-total(energy.forces(state), strip.rows.back(), 1) ==
          Approx(static_cast<double>(c["total_force"])).epsilon(1e-12));
    const EnergyTerms terms = energy.terms(state);
    CHECK(terms.bond == Approx(static_cast<double>(c["U_stretch"])).epsilon(1e-12));
    CHECK(terms.angle == Approx(static_cast<double>(c["U_bend_in_plane"])).epsilon(1e-12));
    const std::vector<int>& middle = strip.rows[n / 2];
    const double width = state.position(0, middle.back()) - state.position(0, middle.front());
    CHECK((1 - width / ((m - 1) * a)) / e ==
          Approx(static_cast<double>(c["mid_height_width_change_over_(m-1)a_e"])).epsilon(1e-15 / e + 1e-12));
  }
}

// From the flat plate to a deflection of more than its thickness in one go.
TEST_CASE("Plates under a load across them", "[solve][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/plate_transverse_load.json")["cases"]))
    for (const auto& s : c["states"]) {
      const std::string edge = c["edge_type"];
      INFO(edge << " q b⁴/Dt = " << s["q b^4/(D t)"]);
      Plate p = plate(c["m_per_row"], c["n_rows"], edge == "straight_simply_supported", c["spacing"], c["K"], c["B"]);
      const auto held = p.edge(edge);
      p.hold(held, [](const Vec3&) { return Vec3::Zero(); });
      std::vector<int> loaded, supported;
      for (int i = 0; i < p.model.particles(); ++i) (held[i][2] ? supported : loaded).push_back(i);
      p.model.loads.push_back({"", loaded, Vec3(0, 0, s["force_per_free_particle_z"]), Scaling()});
      Energy energy(p.model);
      Newton newton(energy);
      State state = p.model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = newton.minimise(state);
      REQUIRE(report.converged());
      UNSCOPED_INFO(report.iterations << " iterations");
      CHECK(report.iterations <= 20);
      const double w = s["w_centre"];
      const int centre = c["centre_particle"], quarter = c["quarter_particle"];
      CHECK(state.position(2, centre) == Approx(w).epsilon(1e-12));
      CHECK(state.position.row(2).maxCoeff() == Approx(static_cast<double>(s["w_max"])).epsilon(1e-12));
      for (int k = 0; k < 3; ++k)
        CHECK(std::abs(state.position(k, quarter) - static_cast<double>(s["position_quarter_particle"][k])) <=
              1e-12 * w);
      CHECK(total(energy.forces(state), supported, 2) ==
            Approx(-static_cast<double>(s["sum_reaction_z"])).epsilon(1e-12));
      energy.evaluate(state);
      CHECK(energy.last_terms().bond == Approx(static_cast<double>(s["U_stretch"])).epsilon(1e-12));
      CHECK(energy.last_terms().angle == Approx(static_cast<double>(s["U_bend"])).epsilon(1e-12));
      CHECK(newton.factors().inertia().negative == static_cast<int>(s["Morse_index"]));
      CHECK(std::abs(newton.factors().lowest(1).values[0] - static_cast<double>(s["smallest_eigenvalue"])) <=
            newton.factors().zero_level());
    }
}

// Pressed together from all sides far beyond buckling: many negative eigenvalues at once, stiff in the plane, soft across it.
TEST_CASE("a sheet that wrinkles takes no more than 200 steps, and few factors a step", "[solve]") {
  for (const double unit : {1e-3, 1e3})
    for (const double strain : {0.01, 0.03}) {
      INFO("unit " << unit << ", strain " << strain);
      Plate p = plate(21, 21, false, unit, 1, 1e-3 * unit * unit);
      p.hold(p.edge("clamped"), [&](const Vec3& x) { return Vec3(-strain * (x - Vec3(10, 8.7, 0) * unit)); });
      std::mt19937 random(3);
      for (int i = 0; i < p.model.particles(); ++i) p.model.start.position(2, i) = 1e-3 * unit * (random() / 4294967296.0 - 0.5);
      Energy energy(p.model);
      Newton newton(energy);
      State state = p.model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = newton.minimise(state);
      INFO(report.why << ", " << report.iterations << " iterations, " << report.factorizations << " factors");
      REQUIRE(report.converged());
      CHECK(report.negative == 0);
      CHECK(report.factorizations <= 6 * report.iterations);
    }
}
