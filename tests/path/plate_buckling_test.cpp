#include "catch.hpp"
#include "path/continuation.hpp"
#include "plate.hpp"
#include "reference.hpp"

using namespace elamin;

namespace {

// Compressed along x with the sides free to slide across: only the bonds along x are stressed, as in the reference, which
// prescribes the sides where they slide to. The transverse stiffness is that of the particles' places alone. The load
// factor is the strain; the events on the way to `to`.
std::vector<PathPoint> events_of_flat(const nlohmann::json& data, const std::string& type, const nlohmann::json& c,
                                      WhenUnstable when_unstable, double to) {
  Plate p =
      plate(c["m_per_row"], c["n_rows"], type == "straight_simply_supported", data["spacing"], data["K"], data["B"]);
  auto held = p.edge(type);
  for (auto& h : held) h[1] = false;
  held[0][1] = true;
  p.hold(held, [](const Vec3& x) { return Vec3(-x[0], 0, 0); });
  Energy energy(p.model);
  Newton newton(energy);
  Continuation path(newton, p.model.start,
                 {.from = 0, .to = to, .steps = 4, .when_unstable = when_unstable, .start = {}, .stops = {}});
  std::vector<PathPoint> events;
  while (const auto point = path.next()) {
    CHECK(point->state.position.row(2).cwiseAbs().maxCoeff() <= 1e-12 * p.spacing());
    if (!point->label.empty() && point->label != "initial") events.push_back(*point);
  }
  INFO(path.why());
  CHECK(path.status() == Status::converged);
  return events;
}

}  // namespace

// An eigenvalue is a quotient of sums of terms that are exact to some ε: its zero is known as well as that.
TEST_CASE("The first two critical strains of flat plates", "[path][reference]") {
  const nlohmann::json data = reference("exact/plate_buckling.json");
  for (const std::string type : {"straight_simply_supported", "pinned_zigzag", "two_layers_fixed"}) {
    const auto& c = data[type]["levels"][0];
    const double first = c["critical_strain"], second = c["second_critical_strain"];
    INFO(type << " " << c["m_per_row"] << " × " << c["n_rows"]);
    const auto events = events_of_flat(data[type], type, c, WhenUnstable::follow, 1.1 * second);
    REQUIRE(events.size() == 2);
    CHECK(events[0].label == "branch:1");
    CHECK(events[1].label == "branch:2");
    CHECK(events[0].state.load_factor == Approx(first).epsilon(1e-12));
    CHECK(events[1].state.load_factor == Approx(second).epsilon(1e-12));
    for (const PathPoint& e : events) CHECK(e.multiplicity == 1);
  }
}

TEST_CASE("The critical strain of a larger flat plate", "[path][reference]") {
  const nlohmann::json data = reference("exact/plate_buckling.json")["straight_simply_supported"];
  const auto& c = data["levels"][1];
  const double first = c["critical_strain"];
  const auto events = events_of_flat(data, "straight_simply_supported", c, WhenUnstable::stop, 1.3 * first);
  REQUIRE(events.size() == 1);
  CHECK(events[0].label == "branch:1");
  CHECK(events[0].state.load_factor == Approx(first).epsilon(1e-12));
}

// The edges go straight to where the reference has them; on the way the sides are a little off the free ones.
TEST_CASE("A buckled plate", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/plate_post_buckling.json")["cases"]))
    for (const auto& s : c["states"]) {
      const double e = s["strain"], a = c["spacing"];
      const std::string type = c["edge_type"];
      INFO(type << " strain " << e);
      Plate p = plate(c["m_per_row"], c["n_rows"], type == "straight_simply_supported", a, c["K"], c["B"]);
      const auto held = p.edge(type);
      const double lateral = std::sqrt((4 - (1 - e) * (1 - e)) / 3) - 1;
      p.hold(held, [&](const Vec3& x) { return Vec3(-e * x[0], lateral * x[1], 0); });
      Energy energy(p.model);
      Newton newton(energy);
      Continuation path(newton, p.model.start,
                     {.from = 0, .to = 1, .steps = 10, .when_unstable = WhenUnstable::jump, .start = {}, .stops = {}});
      PathPoint last;
      int branches = 0;
      while (const auto point = path.next()) {
        last = *point;
        branches += point->label.starts_with("branch");
      }
      INFO(path.why());
      REQUIRE(path.status() == Status::converged);
      CHECK(branches == 1);
      CHECK(last.stability.negative == static_cast<int>(s["Morse_index"]));
      const int centre = c["centre_particle"];
      CHECK(last.state.position(2, centre) == Approx(static_cast<double>(s["w_centre"])).epsilon(1e-12));
      CHECK(last.state.position.row(2).maxCoeff() == Approx(static_cast<double>(s["w_max"])).epsilon(1e-12));
      CHECK(last.energy.bond == Approx(static_cast<double>(s["U_stretch"])).epsilon(1e-12));
      CHECK(last.energy.angle == Approx(static_cast<double>(s["U_bend"])).epsilon(1e-12));
      const Field forces = energy.forces(last.state);
      double force = 0;
      for (int i = 0; i < p.model.particles(); ++i)
        if (held[i][0] && p.model.start.position(0, i) > p.model.start.position.row(0).maxCoeff() / 2 + a / 100)
          force -= forces(0, i);
      CHECK(force == Approx(static_cast<double>(s["x_force_on_held_particles_of_the_right_half"])).epsilon(1e-12));
      energy.evaluate(last.state);
      CHECK(std::abs(newton.factors().lowest(1).values[0] - static_cast<double>(s["smallest_eigenvalue"])) <=
            newton.factors().zero_level());
    }
}
