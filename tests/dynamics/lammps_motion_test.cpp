// Trajectories beside LAMMPS's.
#include "catch.hpp"
#include "dynamics/dynamics_case.hpp"
#include "dynamics/verlet.hpp"
#include "energy/energy.hpp"

using namespace elamin;

namespace {

// Positions to 1e-12 of the extent up to step 10 and 1e-9 at the end, as the README of the cases has it; velocities and forces by
// the same parts of the largest there are.
void follow(const std::string& name) {
  INFO(name);
  const LammpsCase c(name);
  const Model model = model_of_case(c);
  Energy energy(model);
  Verlet verlet(model, begin_motion(model), c.parameters["dynamics"]["dt"]);
  const double extent = (model.start.position.rowwise().maxCoeff() - model.start.position.rowwise().minCoeff()).norm();
  double stiffness = 0;
  for (const BondType& t : model.bond_types) stiffness = std::max(stiffness, 2 * t.stiffness);
  const double rounding = 16 * epsilon * stiffness * largest(model.start.position);   // of the positions, in both programs
  for (const auto& record : c.expected["records"]) {
    const std::int64_t step = record["step"];
    INFO("step " << step);
    CHECK(verlet.advance(step - verlet.motion().step) >= 0);
    const Motion& m = verlet.motion();
    REQUIRE(m.step == step);
    const double tolerance = step <= 10 ? 1e-12 : 1e-9;
    const Field x = field_of(record["positions"]);
    Field v = field_of(record["velocities"]), f = field_of(record["forces"]);
    const bool set_off = step == 0 && !c.parameters["dynamics"]["moved"].empty();
    if (set_off)                                             // LAMMPS gives moved atoms their velocity in the first step only
      for (const Support& s : model.supports)
        for (const int p : s.particles) v.col(p) = m.velocity.col(p), f.col(p) = m.force.col(p);
    CHECK(largest(m.state.position - x) <= tolerance * extent);
    CHECK(largest(m.velocity - v) <= tolerance * std::max(largest(v), extent / (1000 * verlet.timestep())));
    energy.evaluate(m.state, false);
    CHECK(largest(m.force - f) <= tolerance * std::max(largest(f), energy.force_scale()) + rounding);
    if (record.contains("spins")) {
      const Field w = field_of(record["spins"]);
      REQUIRE(m.angular_velocity.cols() == w.cols());
      CHECK(largest(m.angular_velocity - w) <= tolerance * largest(w));
    }
    if (!record.contains("energy_lammps")) continue;
    const EnergyTerms t = energy.terms(m.state);
    const auto near = [&](const nlohmann::json& part, const char* key, double value, double scale) {
      INFO(key);
      if (part.contains(key)) CHECK(std::abs(value - part[key].get<double>()) <= tolerance * std::max(std::abs(value), scale));
    };
    const double scale = verlet.kinetic() + t.size();
    near(record["energy_lammps"], "bond", t.bond, scale);
    near(record["energy_lammps"], "angle", t.angle, scale);
    near(record["energy_lammps"], "gravity", t.external, scale);
    if (!set_off) near(record["energy_lammps"], "kinetic", verlet.kinetic(), scale);
    if (!record.contains("energy_computed")) continue;
    near(record["energy_computed"], "granular", t.contact, scale);
    near(record["energy_computed"], "wall", t.wall, scale);
  }
}

}  // namespace

TEST_CASE("motions follow LAMMPS", "[dynamics]") {
  for (const char* name : {"dyn_clamped_beam", "dyn_grains_box", "dyn_two_beams", "damped_velocity", "damped_mass_velocity",
                           "damped_viscoelastic", "damped_tsuji"}) follow(name);
}
