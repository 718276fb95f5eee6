#pragma once
// Equilibria that every method must find alike.
#include "chain.hpp"
#include "energy/energy.hpp"
#include "model/grains.hpp"
#include "plate.hpp"

#include <cmath>
#include <numeric>
#include <vector>

namespace elamin {

/// A clamped column of 78 particles of diameter 1 in the plane, as stiff as a rod of round section, shortened by so many times what buckles it,
/// 4π² EI/(EA L) = π²/(4 L) for the free length L.
inline Model clamped_column(double overload, int particles = 78) {
  Model m = chain(particles, pi / 8, pi / 64, 1);
  const double length = particles - 3;
  m.plane_normal = 1;
  hold(m, 0, 1);
  hold(m, particles - 2, particles - 1, {true, true, true}, Vec3(0, 0, -overload * pi * pi / (4 * length)));
  return m;
}

/// A clamped sheet, one spacing thick, under a ball that comes down by 1.5 spacings.
inline Model indented_sheet(int rows = 15) {
  Plate p = plate(rows, rows, false, 1, std::sqrt(3) / 4, 1 / (8 * std::sqrt(3)));
  p.hold(p.edge("two_layers_fixed"), [](const Vec3&) { return Vec3::Zero(); });
  const int middle = p.rows[rows / 2][rows / 2];
  Wall ball;
  ball.name = "ball", ball.particles = numbers(p.model.particles()), ball.effective_modulus = 1;
  ball.region.shape = Shape::sphere, ball.region.radius = 3;
  ball.region.center = p.model.start.position.col(middle) + Vec3(0.2, 0.1, 3.5);
  ball.displacement = Vec3(0, 0, -1.5);
  p.model.walls = {ball};
  return p.model;
}

/// Two clamped beams of 30 particles side by side, half a diameter apart, pushed against each other in the middle.
inline Model two_beams() {
  const int n = 30;
  Model m = chain(n, pi / 8, pi / 64, 1);
  const Model other = m;
  m.start.position.conservativeResize(3, 2 * n), m.start.low.conservativeResize(3, 2 * n);
  m.start.position.rightCols(n) = other.start.position, m.start.low.rightCols(n) = other.start.low;
  m.start.position.row(0).tail(n).setConstant(1.5);
  for (const Bond& b : other.bonds) m.bonds.push_back({0, {b.particles[0] + n, b.particles[1] + n}});
  for (const Angle& a : other.angles) m.angles.push_back({0, {a.particles[0] + n, a.particles[1] + n, a.particles[2] + n}});
  m.diameter.assign(2 * n, 1), m.density.assign(2 * n, 1), m.type.assign(2 * n, 1), m.molecule.assign(2 * n, 1);
  m.id = numbers(2 * n, 1);
  m.structures = {{"left", "beam", 0, n, 0, 0, 0}, {"right", "beam", n, n, 0, 0, 0}};
  m.plane_normal = 1;
  for (const int first : {0, n}) hold(m, first, first + 1), hold(m, first + n - 2, first + n - 1);
  PairContact c;
  c.particles = {numbers(n), numbers(n, n)}, c.effective_modulus = 1;
  m.contacts = {c};
  m.loads.push_back({"", numbers(6, n / 2 - 3), Vec3(1e-4, 0, 0), Scaling()});
  return m;
}

/// Five grains in a slot one and a half diameters wide, dropped.
inline Model grains_in_slot() {
  const int n = 5;
  Grains grains;
  grains.name = "grains", grains.diameter.assign(n, 1.0), grains.density = 1;
  grains.position = Field::Zero(3, n);
  for (int i = 0; i < n; ++i) grains.position.col(i) << (i % 2 ? 0.2 : -0.2), 0, 0.6 + 1.1 * i;
  Model m;
  add_grains(m, {grains});
  m.plane_normal = 1;
  PairContact contact;
  contact.particles = {numbers(n), numbers(n)}, contact.effective_modulus = 1e4;
  m.contacts = {contact};
  Wall box;
  box.name = "box", box.particles = numbers(n), box.effective_modulus = 1e4;
  box.region.shape = Shape::block, box.region.lo = Vec3(-0.75, -1, 0), box.region.hi = Vec3(0.75, 1, 10);
  m.walls = {box};
  m.gravity.push_back({"", numbers(n), Vec3(0, 0, -1), Scaling::constant()});
  return m;
}

/// The two-bar truss of pins at (∓1, 0) and its apex at height `apex`, where the bars have their rest length 1.1 to ±0.458; pushed up by `force`: of the
/// minima, apex up and apex down, the upper one is lower.
inline Model two_bar_truss(double apex, double force) {
  Model m;
  m.start.position = Field::Zero(3, 3), m.start.low = Field::Zero(3, 3);
  m.start.position(0, 0) = -1, m.start.position(2, 1) = apex, m.start.position(0, 2) = 1;
  m.bond_types = {{1, 1.1}};
  m.bonds = {{0, {0, 1}}, {0, {1, 2}}};
  m.diameter.assign(3, 0.1), m.density.assign(3, 1), m.id = {1, 2, 3}, m.type.assign(3, 1), m.molecule.assign(3, 1);
  m.structures = {{"truss", "beam", 0, 3, 0, 0, 0}};
  m.plane_normal = 1;
  hold(m, 0, 0), hold(m, 2, 2);
  m.loads.push_back({"", {1}, Vec3(0, 0, force), Scaling()});
  return m;
}

}  // namespace elamin
