#include "catch.hpp"
#include "laws/section.hpp"
#include "model/loop.hpp"
#include "path/continuation.hpp"
#include "reference.hpp"

using namespace elamin;

// A closed ring, bent from straight, squeezed between two opposite particles.
TEST_CASE("A pinched ring", "[solve][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/ring.json")["cases"])) {
    const auto& pinch = c["pinch"];
    const int n = c["N"];
    const double R = pinch["R_polygon"], q0 = c["q0"], B = c["B"];
    Model m;
    add_loops(m, {{"ring", n, Vec3::Zero(), Vec3::UnitZ(), R, q0, 1, c["E"], {c["K"], chord(R, n)}, {B, pi}}});
    m.plane_normal = 2;
    const double largest = pinch["states"].back()["approach"];
    m.supports.push_back({"", {0}, {true, true, true}, Vec3(-largest / 2, 0, 0), Scaling()});
    m.supports.push_back({"", {n / 2}, {true, true, true}, Vec3(largest / 2, 0, 0), Scaling()});
    Energy energy(m);
    Newton newton(energy);
    std::vector<double> stops;
    for (const auto& s : pinch["states"]) stops.push_back(static_cast<double>(s["approach"]) / largest);
    Continuation path(newton, m.start,
                   {.from = 0, .to = 1, .steps = 4, .when_unstable = WhenUnstable::stop, .start = {}, .stops = stops});
    double rest = 0;
    std::size_t next = 0;
    while (const auto point = path.next()) {
      if (point->label == "initial") {  // the polygon itself is an equilibrium
        rest = point->energy.angle;
        CHECK((point->state.position - m.start.position).cwiseAbs().maxCoeff() <= 1e-12 * R);
        CHECK(rest == Approx(n * B * (1 - std::cos(2 * pi / n))).epsilon(1e-12));
      }
      CHECK((point->label == "initial" || point->label.empty()));
      if (next == stops.size() || point->state.load_factor != stops[next]) continue;
      const auto& s = pinch["states"][next++];
      INFO("approach " << s["approach_over_2R"] << " of 2R");
      const auto agrees = [&](double value, const char* key, double accuracy) {
        INFO(key);
        CHECK(value == Approx(static_cast<double>(s[key])).epsilon(accuracy));
      };
      // Bonds stretch by 1e-9 to 1e-5 of what they are long and by exactly as much as the forces say; ε of the positions is
      // not lost on them.
      agrees(energy.forces(point->state)(0, 0), "force", 1e-11);
      agrees(point->energy.bond, "U_stretch", 1e-11);
      agrees(point->energy.angle, "U_bend", 1e-14);
      agrees(point->energy.angle - rest, "U_bend_minus_rest",
             1e-13 + 4 * epsilon * rest / (point->energy.angle - rest));
      const auto y = point->state.position.row(1);
      agrees(y.maxCoeff() - y.minCoeff(), "transverse_extent_max_y_minus_min_y", 1e-14);
      double shortest = q0, longest = 0;
      for (const Bond& b : m.bonds) {
        const double length =
            (point->state.position.col(b.particles[0]) - point->state.position.col(b.particles[1])).norm();
        shortest = std::min(shortest, length), longest = std::max(longest, length);
      }
      agrees(shortest, "min_bond", 1e-14), agrees(longest, "max_bond", 1e-14);
      CHECK(point->stability.negative == static_cast<int>(s["negative_eigenvalues_with_the_two_particles_fixed"]));
      energy.evaluate(point->state);
      const double smallest = s["smallest_eigenvalue"];
      CHECK(std::abs(newton.factors().lowest(1).values[0] - smallest) <= newton.factors().zero_level());
    }
    CHECK(path.status() == Status::converged);
    CHECK(next == stops.size());
  }
}
