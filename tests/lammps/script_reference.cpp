// Forces and energies of the first state of whole scripts, against LAMMPS's own.
#include "catch.hpp"
#include "dynamics/body_case.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "energy/energy.hpp"
#include "lammps/data.hpp"
#include "lammps/script_reading.hpp"
#include "study/run.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>

using namespace elamin;

namespace {

std::map<int, Vec3> lammps_forces(const std::string& name) {
  std::map<int, Vec3> forces;
  std::ifstream in(lammps_scripts + name + ".forces");
  for (int id; in >> id;) in >> forces[id][0] >> forces[id][1] >> forces[id][2];
  return forces;
}

/// The largest difference of the forces in a model's first state from those, over the largest of them. LAMMPS's force is zero where a fix
/// holds an atom: these are counted.
struct Comparison {
  double off = 0;
  std::size_t held = 0;
};

Comparison compared(const Model& model, const std::map<int, Vec3>& expected) {
  REQUIRE(model.id.size() == expected.size());
  Energy energy(model);
  const Field f = energy.forces(model.start);
  Comparison c;
  double largest = 0;
  for (int i = 0; i < model.particles(); ++i) {
    const Vec3& e = expected.at(model.id[i]);
    if (e.isZero(0)) ++c.held;
    else largest = std::max(largest, e.norm()), c.off = std::max(c.off, (f.col(i) - e).norm());
  }
  c.off /= largest;
  return c;
}

}  // namespace

TEST_CASE("forces and energies of the first state of a script are LAMMPS's", "[script]") {
  // LAMMPS has no energy of granular contacts.
  struct Case { const char* name; std::size_t atoms, held; double bond, angle, cohesion; };
  constexpr double unknown = -1e300;
  const Case cases[]{{"column", 24, 0, unknown, unknown, 0},
                     {"grains", 110, 39, 0, 0, unknown},
                     {"glued", 18, 2, unknown, unknown, unknown},
                     {"read", 21, 3, 0.0011973663844225138, 0.032768583779358193, 0},
                     {"shifted", 13, 0, 2.2266138879528174, 1.9150257885011972, 0},
                     {"hertz", 75, 0, 19.532003655294659, 0, -0.010947136603558772},
                     {"material", 100, 0, 0, 0, 0},
                     {"hybrid", 80, 0, 0, 0, -0.0015682027050075576},
                     {"points", 12, 4, 0.021008232564294675, 0.15685050871224257, -0.041393596170558988}};
  for (const Case& c : cases) {
    INFO(c.name);
    const script::Reading reading = script::read_script(lammps_scripts + c.name + ".lmp", {});
    ImportedProblem p = imported(reading);
    const auto expected = lammps_forces(c.name);
    REQUIRE(expected.size() == c.atoms);
    const Comparison comparison = compared(p.model, expected);
    CHECK(comparison.held == c.held);
    CHECK(comparison.off < 1e-12);
    Energy energy(p.model);
    const EnergyTerms terms = energy.terms(p.model.start);
    for (const auto& [found, wanted] : {std::pair(terms.bond, c.bond), std::pair(terms.angle, c.angle), std::pair(terms.cohesion, c.cohesion)})
      if (wanted != unknown) CHECK(std::abs(found - wanted) <= 1e-12 * std::abs(wanted));
  }
}

TEST_CASE("scripts of rounded polyhedra give LAMMPS's forces and torques", "[script][bodies]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    const script::Reading reading = script::read_script(ELAMIN_ROOT "/data/polyhedra/" + c.name + "/in.lammps", {});
    script::TranslationOptions in_motion;
    in_motion.dynamics = true;
    const Model m = imported(reading, 0, in_motion).model;
    REQUIRE(m.bodies.size() == c.bodies.size());
    REQUIRE(follows_lammps(m));
    const LammpsBodyForces found = lammps_body_forces(m, m.start, {Field(), m.body_velocity, m.angular_momentum});
    Wrenches w(found.on.size());
    w.energy = found.energy;
    for (std::size_t k = 0; k < found.on.size(); ++k) w.forces[k] = found.on[k].force, w.torques[k] = found.on[k].torque;
    CHECK(w.off(c.expected["lammps"]) <= 1e-12);
  }
}

TEST_CASE("bonded particles that overlap are left out of granular contacts, as is told, or taken in as by LAMMPS", "[script]") {
  const script::Reading reading = script::read_script(lammps_scripts + "bonded.lmp", {});
  const ImportedProblem p = imported(reading);
  CHECK(compared(p.model, lammps_forces("bonded_apart")).off < 1e-12);
  CHECK(script::report(reading, p.files.notes).find("Here they are left out; exclude_bonds = 0 in [[contact]] takes them in") != std::string::npos);
  const std::string left_out = "exclude_bonds = 1\n";
  std::string text = p.files.toml;
  int contacts = 0;
  for (std::size_t at; (at = text.find(left_out)) != std::string::npos; ++contacts) text[at + left_out.size() - 2] = '0';
  CHECK(contacts == 2);
  const ScratchDirectory scratch;
  scratch.file("p.data", p.files.data);
  CHECK(compared(build_model(read_problem(scratch.file("p.toml", text))), lammps_forces("bonded")).off < 1e-12);
}

TEST_CASE("minimize ends where LAMMPS's ends, one after the other", "[script]") {
  const ScratchDirectory scratch;
  const script::Reading reading = script::read_script(lammps_scripts + "minimize.lmp", {});
  const script::Translated t = script::translated(reading, reading.passes.at(0), {}, "p.data");
  scratch.file("p.data", t.data);
  RunOptions options;
  options.file = scratch.file("p.toml", t.toml), options.directory = scratch / "out", options.quiet = true, options.threads = 1;
  REQUIRE(run(options).exit_status == 0);
  std::ifstream in(lammps_scripts + "minimize.positions");
  const std::array states{"run1", "final"};
  for (int number, id; in >> number >> id;) {
    Vec3 expected;
    in >> expected[0] >> expected[1] >> expected[2];
    const LammpsData state = read_lammps_data(options.directory + "/states/" + states[static_cast<std::size_t>(number - 1)] + ".data");
    const auto at = std::find(state.id.begin(), state.id.end(), id) - state.id.begin();
    INFO(number << ", " << id);
    CHECK((state.position.col(at) - expected).norm() < 1e-11);
  }
}
