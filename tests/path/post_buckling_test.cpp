#include "catch.hpp"
#include "chain.hpp"
#include "path/continuation.hpp"
#include "reference.hpp"

using namespace elamin;

namespace {

// Clamped–clamped chain of data/exact/post_buckling_clamped.json: both ends move, end shortening = load factor.
Model clamped(const nlohmann::json& c, bool plane) {
  const int free = c["N_free_particles"];
  Model m = chain(free + 4, c["K"], c["B"], c["q0"]);
  if (plane) m.plane_normal = 1;
  hold(m, 0, 1);
  hold(m, free + 2, free + 3, {true, true, true}, Vec3(0, 0, -1));
  return m;
}

}  // namespace

TEST_CASE("buckled clamped chains: states, energies, forces and indices", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/post_buckling_clamped.json")["cases"]))
    for (const bool plane : {true, false}) {
      const Model model = clamped(c, plane);
      const double q0 = c["q0"], largest = c["states"].back()["end_shortening"];
      const int free = c["N_free_particles"];
      Energy energy(model);
      Newton newton(energy);
      std::vector<double> stops;
      for (const auto& s : c["states"]) stops.push_back(s["end_shortening"]);
      Continuation path(newton, model.start, {.from = 0, .to = largest, .steps = 20, .when_unstable = WhenUnstable::jump, .start = {}, .stops = stops});
      std::size_t next = 0;
      while (auto point = path.next()) {
        if (point->label == "branch:1") {
          CHECK(point->state.load_factor == Approx(static_cast<double>(c["critical_end_shortening"])).epsilon(1e-9));
          CHECK(point->multiplicity == (plane ? 1 : 2));
        }
        if (next == stops.size() || point->state.load_factor != stops[next]) continue;
        const auto& s = c["states"][next++];
        INFO(c["section"] << " N = " << free << " shortening " << s["end_shortening"] << (plane ? " 2D" : " 3D"));
        double off = 0;
        for (int i = 0; i < free; ++i) {
          // In space the plane of buckling is free: the distance from the axis is what counts.
          const double x = point->state.position(0, i + 2), y = point->state.position(1, i + 2);
          off = std::max(off, std::abs((plane ? x : std::hypot(x, y)) - static_cast<double>(s["positions_x_free"][i])));
          off = std::max(off, std::abs(point->state.position(2, i + 2) - q0 - static_cast<double>(s["positions_z_free"][i])));
        }
        CHECK(off <= 1e-8 * static_cast<double>(s["max_deflection"]));
        CHECK(point->energy.bond == Approx(static_cast<double>(s["U_stretch"])).epsilon(1e-8));
        CHECK(point->energy.angle == Approx(static_cast<double>(s["U_bend"])).epsilon(1e-8));
        CHECK(point->stability.negative == static_cast<int>(s["Morse_index_2D"]));
        CHECK(point->stability.zero == (plane ? 0 : 1));
        CHECK(point->stability.stable);
        if (!plane) {
          REQUIRE(point->stability.zero_modes.size() == 1);
          CHECK(point->stability.zero_modes[0].find("rotation of 'chain' about z") == 0);
        }
        const Field forces = energy.forces(point->state);
        CHECK(forces(2, free + 2) + forces(2, free + 3) == Approx(static_cast<double>(s["end_force_compressive"])).epsilon(1e-8));
        energy.evaluate(point->state);
        const EigenPairs lowest = newton.factors().lowest(3);
        const auto& known = s[plane ? "smallest_eigenvalues_2D" : "smallest_eigenvalues_3D"];
        for (int j = 0; j < 3; ++j)
          CHECK(std::abs(lowest.values[j] - static_cast<double>(known[j])) <= 1e-8 * static_cast<double>(known[2]) + 1e-12);
      }
      CHECK(path.status() == Status::converged);
      CHECK(next == stops.size());
    }
}

TEST_CASE("cantilevers under dead tip loads", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/cantilever.json")["tip_load_transverse"])) {
    const int free = c["N_free_particles"];
    const double q0 = c["q0"];
    for (const auto& s : c["states"]) {
      Model model = chain(free + 2, c["K"], c["B"], q0, Vec3::UnitX());
      model.plane_normal = 2;
      hold(model, 0, 1);
      model.loads.push_back({"", {free + 1}, Vec3(s["tip_force"][0], s["tip_force"][1], 0), Scaling()});
      Energy energy(model);
      Newton newton(energy);
      State state = model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = newton.minimise(state);
      INFO("N = " << free << " PL²/EI = " << s["P_L2_over_EI"]);
      REQUIRE(report.converged());
      CHECK(report.negative == static_cast<int>(s["Morse_index_2D"]));
      const double tip = s["tip_y"];
      CHECK(std::abs(state.position(0, free + 1) - q0 - static_cast<double>(s["tip_x"])) <= 1e-8 * tip);
      CHECK(state.position(1, free + 1) == Approx(tip).epsilon(1e-8));
      energy.evaluate(state);
      CHECK(energy.last_terms().bond == Approx(static_cast<double>(s["U_stretch"])).epsilon(1e-8));
      CHECK(energy.last_terms().angle == Approx(static_cast<double>(s["U_bend"])).epsilon(1e-8));
      CHECK(newton.factors().lowest(1).values[0] == Approx(static_cast<double>(s["smallest_eigenvalue_2D"])).epsilon(1e-8));
    }
  }
}

TEST_CASE("a cantilever under axial load, beyond its critical load", "[path][reference]") {
  const auto c = reference("exact/cantilever.json")["axial_post_buckling"];
  const int free = c["N_free_particles"];
  const double q0 = c["q0"], critical = c["critical_axial_load"];
  Model model = chain(free + 2, c["K"], c["B"], q0, Vec3::UnitX());
  model.plane_normal = 2;
  hold(model, 0, 1);
  model.loads.push_back({"", {free + 1}, Vec3(-1, 0, 0), Scaling()});
  Energy energy(model);
  Newton newton(energy);
  std::vector<double> stops;
  for (const auto& s : c["states"]) stops.push_back(-static_cast<double>(s["tip_force"][0]));
  Continuation path(newton, model.start, {.from = 0, .to = stops.back(), .steps = 20, .when_unstable = WhenUnstable::jump, .start = {}, .stops = stops});
  std::size_t next = 0;
  while (auto point = path.next()) {
    if (point->label == "branch:1") CHECK(point->state.load_factor == Approx(critical).epsilon(1e-9));
    if (next == stops.size() || point->state.load_factor != stops[next]) continue;
    const auto& s = c["states"][next++];
    const double tip = s["tip_y"];
    CHECK(point->state.position(1, free + 1) == Approx(tip).epsilon(1e-8));
    CHECK(std::abs(point->state.position(0, free + 1) - q0 - static_cast<double>(s["tip_x"])) <= 1e-8 * tip);
    CHECK(point->energy.angle == Approx(static_cast<double>(s["U_bend"])).epsilon(1e-8));
    CHECK(point->stability.negative == static_cast<int>(s["Morse_index_2D"]));
  }
  CHECK(path.status() == Status::converged);
  CHECK(next == stops.size());
}

TEST_CASE("a chain rolled up by an end couple lies on a circle", "[path][reference]") {
  const auto all = reference("exact/cantilever.json")["end_moment"];
  for (const auto& c : all) {
    // The last two particles are held where the couple M = B sin φ puts them; the others start off the circle.
    const int free = c["N_free_particles"];
    const double q0 = c["q0"], B = c["B"], phi = c["phi"];
    Model model = chain(free + 2, 8 * B / (q0 * q0), B, q0, Vec3::UnitX());
    model.plane_normal = 2;
    Vec3 at(-q0, 0, 0);
    for (int i = 0; i < free + 2; ++i) {
      model.start.position.col(i) = at, model.start.low.col(i).setZero();
      const double slope = std::max(0, i) * phi;
      at += q0 * Vec3(std::cos(slope), std::sin(slope), 0);
    }
    const Field circle = model.start.position;
    for (int i = 2; i < free; ++i) model.start.position.col(i) += 0.01 * q0 * Vec3(std::sin(i), std::cos(2.0 * i), 0);
    hold(model, 0, 1), hold(model, free, free + 1);
    Energy energy(model);
    Newton newton(energy);
    State state = model.start;
    const Report report = newton.minimise(state);
    REQUIRE(report.converged());
    CHECK((state.position - circle).cwiseAbs().maxCoeff() <= 1e-12 * q0 * free);
    CHECK(energy.terms(state).angle == Approx(static_cast<double>(c["U_bend"])).epsilon(1e-10));
    for (std::size_t k = 0; k < c["positions"].size(); ++k) {
      const int number = c["positions_of_free_particles_number"][k];
      for (int d = 0; d < 2; ++d)
        CHECK(std::abs(state.position(d, number + 1) - static_cast<double>(c["positions"][k][d])) <= 1e-8 * q0);
    }
  }
}
