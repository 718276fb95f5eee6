// Structures that are not quite as they are meant, and values of particles, bonds and angles of their own.
#include "model/imperfection.hpp"

#include "catch.hpp"
#include "energy/energy.hpp"
#include "model/beam.hpp"
#include "model/geometry.hpp"
#include "model/row_values.hpp"

#include <cmath>
#include <limits>

using namespace elamin;

namespace {

Model straight_beam(int n) {
  Model m;
  add_beams(m, {{"beam", row(exact(Vec3(0, 0, 0)), exact(Vec3(n - 1.0, 0, 0)), n).centers, 1, 0, 0, {10, 1}, {3}}});
  m.plane_normal = 1;
  return m;
}

Field waves(int n) {
  Field by = Field::Zero(3, n);
  for (int i = 0; i < n; ++i) by.col(i) = Vec3(1e-3 * i, 0, 1e-2 * std::sin(0.7 * i));
  return by;
}

}  // namespace

TEST_CASE("A stress-free imperfection has no forces, without it the perfect lengths and angles pull", "[model]") {
  Model made = straight_beam(9), forced = made;
  displace(made, waves(9), true), displace(forced, waves(9), false);
  CHECK(made.imperfection == Approx(waves(9).colwise().norm().maxCoeff()));
  CHECK(made.start.position == forced.start.position);
  const double of_made = Energy(made).forces(made.start).norm(), of_forced = Energy(forced).forces(forced.start).norm();
  CHECK(of_forced > 1e-2);
  CHECK(of_made < 16 * epsilon * 20);                    // rounding beside 2K r0
  CHECK(forced.bond_types.size() == 1);
  // Bonds and angles keep their stiffnesses, and the structure its first types.
  for (const BondType& t : made.bond_types) CHECK(t.stiffness == 10);
  for (const AngleType& t : made.angle_types) CHECK(t.stiffness == 3);
  CHECK(made.structures[0].bond_type == 0);
  CHECK(made.structures[0].angle_type == 0);
}

TEST_CASE("What a structure was strained by before it is strained by after an imperfection", "[model]") {
  Model m = straight_beam(5);
  m.bond_types[0].rest_length = 1.25;                    // prestressed: every bond is 0.25 shorter than at rest
  displace(m, waves(5), true);
  for (const Bond& b : m.bonds) {
    const double length = norm(m.start.at(b.particles[1]) - m.start.at(b.particles[0])).value();
    CHECK(m.bond_types[b.type].rest_length - length == Approx(0.25).epsilon(1e-14));
  }
}

TEST_CASE("Moved along itself a row is not bent, across, it is", "[model]") {
  const Model m = straight_beam(5);
  Field along = Field::Zero(3, 5);
  along.row(0).setLinSpaced(5, 0, 1e-3);
  CHECK_FALSE(bends_a_row(m, along));
  Field turned = along;
  turned.row(2).setLinSpaced(5, 0, 1e-3);
  CHECK_FALSE(bends_a_row(m, turned));
  CHECK(bends_a_row(m, waves(5)));
}

TEST_CASE("Own values go to the bond behind a particle and to the angle over it", "[model]") {
  Model m = straight_beam(4);
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(has_bond_behind(m, m.structures[0]) == std::vector<bool>{true, true, true, false});
  CHECK(has_angle_in_the_middle(m, m.structures[0]) == std::vector<bool>{false, true, true, false});
  set_own_values(m, m.structures[0], {{2, none, none, 3}, {}, {none, 7, 7, none}, {none, none, 0.5, none}, {none, none, 4, none}});
  CHECK(m.diameter == std::vector<double>{2, 1, 1, 3});
  const auto bond = [&](int b) { return m.bond_types[m.bonds[b].type]; };
  CHECK((bond(0).stiffness == 10 && bond(0).rest_length == 1));
  CHECK((bond(1).stiffness == 7 && bond(1).rest_length == 1));
  CHECK((bond(2).stiffness == 7 && bond(2).rest_length == 0.5));
  CHECK(m.angle_types[m.angles[0].type].stiffness == 3);
  CHECK(m.angle_types[m.angles[1].type].stiffness == 4);
}
