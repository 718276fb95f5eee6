#include "catch.hpp"
#include "laws/section.hpp"
#include "model/grains.hpp"
#include "reference.hpp"
#include "solve/newton.hpp"

using namespace elamin;

namespace {

struct Rested {
  State state;
  EnergyTerms terms;
  std::vector<Touch> touches;
};

Rested rest(const Model& m) {
  Energy energy(m);
  Newton newton(energy);
  Rested r{m.start, {}, {}};
  energy.kinematics().prescribe(r.state, 1);
  const Report report = newton.minimise(r.state);
  INFO(report.why);
  REQUIRE(report.converged());
  r.terms = energy.terms(r.state), r.touches = energy.touches(r.state);
  return r;
}

Model spheres(const Field& places, const std::vector<double>& radii, double density) {
  Model m;
  std::vector<double> diameters;
  for (const double r : radii) diameters.push_back(2 * r);
  add_grains(m, {{"grains", places, diameters, density}});
  return m;
}

void let_touch(Model& m, double modulus) {
  PairContact c;
  for (int i = 0; i < m.particles(); ++i) c.particles[0].push_back(i);
  c.particles[1] = c.particles[0], c.effective_modulus = modulus;
  m.contacts.push_back(c);
}

void wall(Model& m, const Vec3& normal, double modulus) {
  Wall w;
  for (int i = 0; i < m.particles(); ++i) w.particles.push_back(i);
  w.region.normal = normal.normalized(), w.effective_modulus = modulus;
  m.walls.push_back(w);
}

// Of overlaps, forces and energies. Positions are kept to twice the digits: an overlap of 1e-3 radii is as exact as they are,
// once the last step of Newton's method has squared a residual below 1e-8.
constexpr double accuracy = 1e-13;

double number(const nlohmann::json& j, const char* key) { return j[key]; }

// What a wall's modulus is called in the reference, as printed in eq. 5, rigid, or of the spheres' own material.
const std::array<const char*, 3> variants{"reference_eq5_E", "rigid_wall_E/(1-nu^2)", "same_material_E/(2(1-nu^2))"};
double wall_modulus(int variant, double E, double nu) { return variant == 0 ? E : E / ((1 - nu * nu) * variant); }

}  // namespace

TEST_CASE("Two spheres pressed together", "[solve][contact][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/hertz.json")["spheres"])) {
    const double r1 = c["r1"], r2 = c["r2"], F = c["F"];
    Field x = Field::Zero(3, 2);
    x(0, 1) = 1.5 * (r1 + r2);
    Model m = spheres(x, {r1, r2}, 1);
    let_touch(m, c["E_eff"]);
    m.supports.push_back({"", {0}, {true, true, true}, Vec3::Zero(), Scaling()});
    m.supports.push_back({"", {1}, {false, true, true}, Vec3::Zero(), Scaling()});
    m.loads.push_back({"", {1}, Vec3(-F, 0, 0), Scaling()});
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    energy.kinematics().prescribe(state, 1);
    REQUIRE(newton.minimise(state).converged());
    const double overlap = c["overlap"], distance = c["centre_distance"];
    CHECK(state.position(0, 1) == Approx(distance).epsilon(8 * epsilon));
    const auto touches = energy.touches(state);
    REQUIRE(touches.size() == 1);
    CHECK(-touches[0].gap == Approx(overlap).epsilon(accuracy));
    CHECK(touches[0].force.norm() == Approx(F).epsilon(accuracy));
    energy.evaluate(state);
    CHECK(energy.last_terms().contact == Approx(number(c, "energy")).epsilon(accuracy));
    CHECK(energy.hessian().coeff(0, 0) == Approx(number(c, "stiffness_dF_ddelta")).epsilon(accuracy));
  }
}

TEST_CASE("A stack of spheres on a wall", "[solve][contact][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/hertz.json")["stack"]))
    for (int v = 0; v < 3; ++v) {
      const auto& known = c["variants"][variants[v]];
      const double r = c["r"], modulus = wall_modulus(v, c["E"], c["nu"]);
      const int n = c["n"];
      INFO(n << " spheres, " << variants[v]);
      CHECK(modulus == Approx(number(known, "wall_modulus_in_F=4/3_E_sqrt(r)_delta^1.5")).epsilon(4 * epsilon));
      Field x = Field::Zero(3, n);
      for (int i = 0; i < n; ++i) x(2, i) = (2 * i + 1) * 1.1 * r;  // above one another, nothing touches
      Model m = spheres(x, std::vector<double>(n, r), c["density"]);
      let_touch(m, c["E_eff_pair"]), wall(m, Vec3::UnitZ(), modulus);
      Support upright;
      for (int i = 0; i < n; ++i) upright.particles.push_back(i);
      upright.held = {true, true, false};
      m.supports.push_back(upright);
      m.gravity.push_back({"", upright.particles, Vec3(0, 0, -number(c, "g")), Scaling::constant()});
      CHECK(m.mass(0) == Approx(number(c, "mass")).epsilon(8 * epsilon));
      const Rested s = rest(m);
      for (int i = 0; i < n; ++i)
        CHECK(s.state.position(2, i) == Approx(known["z"][i].get<double>()).epsilon(8 * epsilon));
      REQUIRE(static_cast<int>(s.touches.size()) == n);
      for (int i = 0; i + 1 < n; ++i)
        CHECK(-s.touches[i].gap == Approx(c["pair_overlaps_from_the_wall_up"][i].get<double>()).epsilon(accuracy));
      CHECK(s.touches.back().wall == 0);
      CHECK(-s.touches.back().gap == Approx(number(known, "wall_overlap")).epsilon(accuracy));
      CHECK(s.touches.back().force[2] == Approx(number(known, "wall_force")).epsilon(accuracy));
      CHECK(s.terms.total() == Approx(number(known, "total_energy_contact_plus_mgz")).epsilon(accuracy));
    }
}

TEST_CASE("A sphere in a corner of two planes", "[solve][contact][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/hertz.json")["corner"]))
    for (int v = 0; v < 3; ++v) {
      const auto& known = c["variants"][variants[v]];
      const double r = c["r"], left = number(c, "angle_left_plane_deg") * pi / 180,
                   right = number(c, "angle_right_plane_deg") * pi / 180;
      INFO(c["angle_left_plane_deg"] << "°, " << c["angle_right_plane_deg"] << "°, " << variants[v]);
      Field x = Field::Zero(3, 1);
      x.col(0) = Vec3(0.3 * r, 3 * r, 0);
      Model m = spheres(x, {r}, c["density"]);
      m.plane_normal = 2;
      const double modulus = wall_modulus(v, c["E"], c["nu"]);
      wall(m, Vec3(std::sin(left), std::cos(left), 0), modulus),
          wall(m, Vec3(-std::sin(right), std::cos(right), 0), modulus);
      m.gravity.push_back({"", {0}, Vec3(0, -number(c, "g"), 0), Scaling::constant()});
      const Rested s = rest(m);
      CHECK(std::abs(s.state.position(0, 0) - number(known, "x")) <= 8 * epsilon * r);
      CHECK(std::abs(s.state.position(1, 0) - number(known, "y")) <= 8 * epsilon * r);
      REQUIRE(s.touches.size() == 2);
      CHECK(-s.touches[0].gap == Approx(number(known, "overlap_left")).epsilon(accuracy));
      CHECK(-s.touches[1].gap == Approx(number(known, "overlap_right")).epsilon(accuracy));
      CHECK(s.touches[0].force.norm() == Approx(number(c, "N_left_plane")).epsilon(accuracy));
      CHECK(s.touches[1].force.norm() == Approx(number(c, "N_right_plane")).epsilon(accuracy));
    }
}

TEST_CASE("A sphere in the groove of two others", "[solve][contact][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/hertz.json")["groove"])) {
    const double r = c["r"], apart = c["centre_spacing_of_fixed_spheres"], E = c["E"], nu = c["nu"];
    Field x = Field::Zero(3, 3);
    x(0, 0) = -apart / 2, x(0, 1) = apart / 2, x(0, 2) = 0.2 * r, x(1, 2) = 3 * r;
    Model m = spheres(x, {r, r, r}, c["density"]);
    m.plane_normal = 2;
    let_touch(m, E / (2 * (1 - nu * nu)));
    m.supports.push_back({"", {0, 1}, {true, true, true}, Vec3::Zero(), Scaling()});
    m.gravity.push_back({"", {2}, Vec3(0, -number(c, "g"), 0), Scaling::constant()});
    const Rested s = rest(m);
    CHECK(std::abs(s.state.position(0, 2)) <= 8 * epsilon * r);
    CHECK(s.state.position(1, 2) == Approx(number(c, "y")).epsilon(8 * epsilon));
    REQUIRE(s.touches.size() >= 2);
    for (const Touch& t : s.touches) {
      CHECK(-t.gap == Approx(number(c, "overlap_each")).epsilon(accuracy));
      CHECK(t.force.norm() == Approx(number(c, "normal_force_each")).epsilon(accuracy));
    }
  }
}
