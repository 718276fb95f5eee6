#include "catch.hpp"
#include "chain.hpp"
#include "path/continuation.hpp"
#include "reference.hpp"

using namespace elamin;

namespace {

// The chains of data/exact/chain_critical.json: along z, or along an oblique line in 3D.
Model column(const nlohmann::json& c, bool plane, const Vec3& axis) {
  const std::string ends = c["ends"];
  const int free = c["N_free_particles"];
  const double q0 = c["q0"], K = c["K"], B = c["B"];
  const bool clamped_start = ends.starts_with("clamped"), clamped_end = ends == "clamped-clamped", free_end = ends == "clamped-free";
  const int before = clamped_start ? 2 : 1, after = free_end ? 0 : clamped_end ? 2 : 1;
  Model m = chain(before + free + after, K, B, q0, axis);
  if (plane) m.plane_normal = 1;
  hold(m, 0, before - 1);
  if (free_end) m.loads.push_back({"", {before + free - 1}, -axis.normalized(), Scaling()});
  else hold(m, before + free, before + free + after - 1, {true, true, true}, -axis.normalized());
  return m;
}

// The load factor of critical state k: end shortening, or the dead load.
double critical(const nlohmann::json& c, int k) {
  return c["ends"] == "clamped-free" ? c["axial_force"][k] : c["end_shortening"][k];
}

}  // namespace

TEST_CASE("critical loads of straight chains, first loss of stability", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/chain_critical.json")["cases"]))
    for (const bool plane : {true, false}) {
      const Model model = column(c, plane, Vec3::UnitZ());
      Energy energy(model);
      Newton newton(energy);
      Continuation path(newton, model.start, {.from = 0, .to = 1.7 * critical(c, 0), .steps = 7, .when_unstable = WhenUnstable::stop, .start = {}, .stops = {}});
      std::optional<PathPoint> last;
      while (auto point = path.next()) last = point;
      INFO(c["ends"] << " " << c["section"] << " N = " << c["N_free_particles"] << (plane ? " 2D" : " 3D"));
      REQUIRE(path.status() == Status::converged);
      REQUIRE(last->label == "branch:1");
      CHECK(last->state.load_factor == Approx(critical(c, 0)).epsilon(1e-9));
      CHECK(last->multiplicity == (plane ? 1 : 2));
      CHECK(last->stability.negative == 0);
    }
}

TEST_CASE("critical loads of an oblique chain in space", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/chain_critical.json")["cases"])) {
    if (c["section"] != "generic") continue;
    const Model model = column(c, false, Vec3(1, -2, 0.7));
    Energy energy(model);
    Newton newton(energy);
    Continuation path(newton, model.start, {.from = 0, .to = 1.7 * critical(c, 0), .steps = 7, .when_unstable = WhenUnstable::stop, .start = {}, .stops = {}});
    std::optional<PathPoint> last;
    while (auto point = path.next()) last = point;
    INFO(c["ends"] << " N = " << c["N_free_particles"]);
    REQUIRE(last->label == "branch:1");
    CHECK(last->state.load_factor == Approx(critical(c, 0)).epsilon(1e-9));
    CHECK(last->multiplicity == 2);
  }
}

TEST_CASE("the first four critical loads, following the straight branch", "[path][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/chain_critical.json")["cases"]))
    for (const bool plane : {true, false}) {
      if (static_cast<int>(c["N_free_particles"]) > 40) continue;
      const Model model = column(c, plane, Vec3::UnitZ());
      Energy energy(model);
      Newton newton(energy);
      // As many transverse modes in a plane as free particles, whatever the closed form lists beyond.
      const int known = std::min(static_cast<int>(c["mu"].size()), static_cast<int>(c["N_free_particles"]));
      Continuation path(newton, model.start, {.from = 0, .to = 1.02 * critical(c, known - 1), .steps = 10, .when_unstable = WhenUnstable::follow, .start = {}, .stops = {}});
      INFO(c["ends"] << " " << c["section"] << " N = " << c["N_free_particles"] << (plane ? " 2D" : " 3D"));
      int found = 0;
      while (auto point = path.next()) {
        const int each = plane ? 1 : 2;
        if (point->label.starts_with("branch")) {
          REQUIRE(found < known);
          CHECK(point->state.load_factor == Approx(critical(c, found)).epsilon(1e-9));
          CHECK(point->multiplicity == each);
          ++found;
        } else {
          CHECK(point->stability.negative == each * found);
        }
      }
      CHECK(path.status() == Status::converged);
      CHECK(found == known);
    }
}

TEST_CASE("events do not depend on the step length", "[path]") {
  const auto c = reference("exact/chain_critical.json")["cases"][0];
  for (const int steps : {1, 10, 100}) {
    const Model model = column(c, true, Vec3::UnitZ());
    Energy energy(model);
    Newton newton(energy);
    Continuation path(newton, model.start, {.from = 0, .to = 1.5 * critical(c, 0), .steps = steps, .when_unstable = WhenUnstable::jump, .start = {}, .stops = {}});
    int events = 0;
    while (auto point = path.next())
      if (point->label.starts_with("branch")) {
        ++events;
        CHECK(point->state.load_factor == Approx(critical(c, 0)).epsilon(1e-12));
      }
    CHECK(events == 1);
    CHECK(path.status() == Status::converged);
  }
}
