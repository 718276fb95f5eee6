// Forces and energies of the first state of whole scripts, against LAMMPS's own.
#include "catch.hpp"
#include "dynamics/body_case.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "energy/energy.hpp"
#include "lammps/script_reading.hpp"

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
                     {"hybrid", 80, 0, 0, 0, -0.0015682027050075576}};
  for (const Case& c : cases) {
    INFO(c.name);
    const script::Reading reading = script::read_script(lammps_scripts + c.name + ".lmp", {});
    ImportedProblem p = imported(reading);
    Energy energy(p.model);
    const Field f = energy.forces(p.model.start);
    const auto expected = lammps_forces(c.name);
    REQUIRE(expected.size() == c.atoms);
    REQUIRE(p.model.id.size() == c.atoms);
    double largest = 0, off = 0;
    std::size_t held = 0;
    for (int i = 0; i < p.model.particles(); ++i) {
      const Vec3& e = expected.at(p.model.id[i]);
      if (e.isZero(0)) ++held;
      else largest = std::max(largest, e.norm()), off = std::max(off, (f.col(i) - e).norm());
    }
    CHECK(held == c.held);
    CHECK(off < 1e-12 * largest);
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
