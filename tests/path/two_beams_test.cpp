#include "catch.hpp"
#include "laws/section.hpp"
#include "model/beam.hpp"
#include "path/continuation.hpp"
#include "reference.hpp"

#include <numeric>

using namespace elamin;

namespace {

// Two clamped chains side by side, pressed by compression/2 from both ends; the load factor is the compression.
struct Beams {
  Model model;
  std::array<int, 2> first{}, last{};  // of the thin and the thick one
  int mid(int b) const { return (first[b] + last[b]) / 2; }
  double bow(int b, const State& x) const { return x.position(0, mid(b)) - model.start.position(0, mid(b)); }
  /// Compressive force at the upper clamp.
  double end_force(int b, const Field& forces) const { return forces(2, last[b]) + forces(2, last[b] - 1); }
};

Beams beams(const nlohmann::json& c, bool plane) {
  Beams b;
  const double apart = c["centre_line_distance"];
  const std::array<std::string, 2> names{"thin", "thick"};
  std::vector<Beam> made;
  for (int k = 0; k < 2; ++k) {
    const int n = static_cast<int>(c["N_" + names[k]]) + 4;
    const double d = c["d_" + names[k]];
    Beam s;
    s.name = names[k], s.diameter = d, s.density = 1;
    const auto ends = ends_of_row(Vec3((k - 0.5) * apart, 0, 0), Vec3::UnitZ(), d, n - 1);
    s.centers = row(ends[0], ends[1], n).centers;
    s.bond = {c["K_" + names[k]], d}, s.angle = {c["B_" + names[k]]};
    b.first[k] = k == 0 ? 0 : b.last[0] + 1, b.last[k] = b.first[k] + n - 1;
    made.push_back(s);
  }
  add_beams(b.model, made);
  for (int k = 0; k < 2; ++k) {
    b.model.supports.push_back({"", {b.first[k], b.first[k] + 1}, {true, true, true}, Vec3(0, 0, 0.5), Scaling()});
    b.model.supports.push_back({"", {b.last[k] - 1, b.last[k]}, {true, true, true}, Vec3(0, 0, -0.5), Scaling()});
  }
  PairContact contact;
  for (int k = 0; k < 2; ++k) {
    contact.particles[k].resize(b.last[k] - b.first[k] + 1);
    std::iota(contact.particles[k].begin(), contact.particles[k].end(), b.first[k]);
  }
  contact.effective_modulus = c["E_eff"];
  b.model.contacts.push_back(contact);
  if (plane) b.model.plane_normal = 1;
  return b;
}

// The equilibrium with bows of these sizes at this compression.
State bowed(const Beams& b, Newton& newton, double compression, double thin, double thick) {
  State x = b.model.start;
  newton.energy().kinematics().prescribe(x, compression);
  for (int k = 0; k < 2; ++k) {
    const double half = b.model.start.position(2, b.last[k] - 1);
    for (int p = b.first[k] + 2; p <= b.last[k] - 2; ++p)
      x.position(0, p) += (k == 0 ? thin : thick) * (1 + std::cos(pi * b.model.start.position(2, p) / half)) / 2;
  }
  const Report report = newton.minimise(x);
  INFO(report.why);
  REQUIRE(report.converged());
  return x;
}

// In space a bowed beam without contact turns about its axis at no cost; two in contact fall past each other.
int negative_in_space(const nlohmann::json& c, const State& x) {
  const Beams b = beams(c, false);
  Energy energy(b.model);
  energy.evaluate(x);
  return Factors(energy).inertia().negative;
}

void check_state(const Beams& b, const nlohmann::json& c, Newton& newton, const PathPoint& point,
                 const nlohmann::json& s, double thick_sign = 1) {
  INFO("compression " << s["compression"] << ", " << s["regime"]);
  // Rounded doubles on both sides: some ten roundings of a diameter, of the whole energy, of the largest force.
  const auto near = [&](double value, const nlohmann::json& expected, double scale) {
    CHECK(std::abs(value - expected.get<double>()) <= 64 * epsilon * scale);
  };
  const double size = b.model.diameter[0];
  near(b.bow(0, point.state), s["x_mid_thin_minus_rest"], size);
  near(thick_sign * b.bow(1, point.state), s["x_mid_thick_minus_rest"], size);
  const double bond = s["U_stretch"], total_energy = bond + s["U_bend"].get<double>();
  near(point.energy.bond, s["U_stretch"], total_energy);
  near(point.energy.angle, s["U_bend"], total_energy);
  near(point.energy.contact, s["U_contact"], total_energy);
  Energy& energy = newton.energy();
  const Field forces = energy.forces(point.state);
  near(b.end_force(0, forces), s["end_force_thin"], s["end_force_thick"]);
  near(b.end_force(1, forces), s["end_force_thick"], s["end_force_thick"]);
  const auto touches = energy.touches(point.state);
  const auto& known = s["contacts_[thin,thick,overlap,force]"];
  REQUIRE(touches.size() == known.size());
  double total = 0;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    CHECK(touches[i].particle == known[i][0].get<int>());
    CHECK(touches[i].other - b.first[1] == known[i][1].get<int>());
    near(-touches[i].gap, known[i][2], size);
    near(touches[i].force.norm(), known[i][3], s["end_force_thick"]);
    total += touches[i].force.norm();
  }
  near(total, s["total_contact_force"], s["end_force_thick"]);
  const int negative = s["Morse_index_2D"];
  CHECK(point.stability.negative == negative);
  CHECK(negative_in_space(c, point.state) == negative + s["negative_out_of_plane"].get<int>());
  energy.evaluate(point.state);
  const double symmetric = s["smallest_eigenvalue_mirror_symmetric"],
               antisymmetric = s["smallest_eigenvalue_mirror_antisymmetric"];
  CHECK(std::abs(newton.factors().lowest(1).values[0] - std::min(symmetric, antisymmetric)) <=
        newton.factors().zero_level());
}

}  // namespace

TEST_CASE("Two beams before they touch, and both bowed to one side", "[path][contact][reference]") {
  const nlohmann::json c = reference("exact/two_beams.json")["cases"][0];
  const Beams b = beams(c, true);
  Energy energy(b.model);
  Newton newton(energy);
  std::vector<double> stops;
  for (const auto& s : c["path"]) stops.push_back(s["compression"]);
  Continuation path(
      newton, b.model.start,
      {.from = 0, .to = stops.back(), .steps = 8, .when_unstable = WhenUnstable::jump, .start = {}, .stops = stops});
  std::vector<std::string> events;
  std::size_t next = 0;
  while (const auto point = path.next()) {
    if (!point->label.empty()) events.push_back(point->label);
    if (point->label == "branch:1")
      CHECK(point->state.load_factor == Approx(c["critical_compression_thin"].get<double>()).epsilon(1e-11));
    if (point->label == "branch:2")
      CHECK(point->state.load_factor == Approx(c["critical_compression_thick"].get<double>()).epsilon(1e-11));
    if (next == stops.size() || point->state.load_factor != stops[next]) continue;
    const auto& s = c["path"][next++];
    const std::string regime = s["regime"];
    // Falling from the straight line the thick beam goes to +x, as the thin one does: a mirror image while nothing touches.
    if (regime == "both buckled towards each other") check_state(b, c, newton, *point, s, -1);
    else if (regime != "in contact") check_state(b, c, newton, *point, s);
  }
  INFO(path.why());
  CHECK(path.status() == Status::converged);
  CHECK(next == stops.size());
  CHECK(events == std::vector<std::string>{"initial", "branch:1", "jump:1", "branch:2", "jump:2"});
}

// The thin beam bows to +x, the thick one to -x, until they touch; then the thin one pushes the thick one back. Gaps up to
// 5 mm end at a limit point next to where the contact would be lost, and a fall to both beams bowed to +x; 6 mm where the
// middles start to slip past each other.
TEST_CASE("Two beams pressed against each other", "[path][contact][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/two_beams.json")["cases"])) {
    const auto& loss = c["loss_of_stability"];
    const bool limit = loss["type"].get<std::string>().starts_with("limit");
    INFO("gap " << c["gap_between_surfaces"]);
    const Beams b = beams(c, true);
    Energy energy(b.model);
    Newton newton(energy);
    const double size = b.model.diameter[0], begin = limit ? 0.00053 : 0.0006;
    const State start = bowed(b, newton, begin, 1.15 * size, -0.2 * size);
    std::vector<nlohmann::json> states;
    std::vector<double> stops;
    for (const auto& s : c["path"])
      if (s["compression"].get<double>() > begin) states.push_back(s), stops.push_back(s["compression"]);
    const double end = limit ? stops.back() : 1.01 * loss["compression"].get<double>();
    Continuation path(newton, start,
                   {.from = begin,
                    .to = end,
                    .steps = 20,
                    .when_unstable = limit ? WhenUnstable::jump : WhenUnstable::stop,
                    .start = {},
                    .stops = stops});
    std::vector<std::string> events;
    std::size_t next = 0;
    while (const auto point = path.next()) {
      if (!point->label.empty()) events.push_back(point->label);
      if (point->label == "contact:1") {
        CHECK(point->state.load_factor == Approx(c["contact_onset_compression"].get<double>()).epsilon(1e-12));
        for (int k = 0; k < 2; ++k)
          CHECK(std::abs(b.bow(k, point->state) - c["mids_at_onset"][k].get<double>()) <= 1e-11 * size);
      }
      if (point->label.starts_with("limit") || point->label.starts_with("branch")) {
        CHECK(point->state.load_factor == Approx(loss["compression"].get<double>()).epsilon(1e-12));
        const auto touches = energy.touches(point->state);
        REQUIRE(touches.size() == 1);
        // At a limit point positions are known to the root of what the load is, and the reference gives them to 1e-8.
        for (int k = 0; k < 2; ++k)
          CHECK(std::abs(b.bow(k, point->state) - loss["mids"][k].get<double>()) <= 1e-8 * size);
        CHECK(-touches[0].gap == Approx(loss["overlap"].get<double>()).epsilon(1e-6));
        CHECK(touches[0].force.norm() == Approx(loss["contact_force"].get<double>()).epsilon(1e-6));
      }
      if (next == stops.size() || point->state.load_factor != stops[next]) continue;
      check_state(b, c, newton, *point, states[next++]);
    }
    INFO(path.why());
    CHECK(path.status() == Status::converged);
    CHECK(next == stops.size());
    std::vector<std::string> expected{"initial", "contact:1", limit ? "limit:1" : "branch:1"};
    if (limit) expected.push_back("jump:1");
    CHECK(events == expected);
  }
}
