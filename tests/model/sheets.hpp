#pragma once
// Sheets for tests, and what is asked of each of them.
#include "model/beam.hpp"
#include "model/geometry.hpp"
#include "model/sheet.hpp"

namespace elamin {

constexpr double degree = exact_pi.hi / 180;

inline Model built(const Sheet& s) {
  Model m;
  add_sheets(m, {s});
  return m;
}

inline Sheet sheet(Sheet::Shape shape, double spacing) {
  Sheet s;
  s.name = "sheet", s.shape = shape, s.spacing = s.diameter = spacing;
  s.bond_stiffness = 2, s.angle_stiffness = 3;
  return s;
}

inline Sheet rectangle(double lx, double ly, double spacing, double lattice_angle = 0) {
  Sheet s = sheet(Sheet::Shape::rectangle, spacing);
  s.size = {lx, ly}, s.lattice_angle = lattice_angle;
  return s;
}

inline Sheet circle(double radius, double spacing, double lattice_angle = 0) {
  Sheet s = sheet(Sheet::Shape::circle, spacing);
  s.radius = radius, s.lattice_angle = lattice_angle;
  return s;
}

inline Sheet cylinder(double radius, double height, double spacing, double lattice_angle = 0) {
  Sheet s = sheet(Sheet::Shape::cylinder, spacing);
  s.radius = radius, s.height = height, s.lattice_angle = lattice_angle, s.as_built = true;
  return s;
}

inline Exact length_of(const Model& m, const Bond& b) {
  return distance(m.start.at(b.particles[0]), m.start.at(b.particles[1]));
}

/// How many bonds each particle has.
inline std::vector<int> bonds_of_each(const Model& m) {
  std::vector<int> bonds(m.particles());
  for (const Bond& b : m.bonds) ++bonds[b.particles[0]], ++bonds[b.particles[1]];
  return bonds;
}

}  // namespace elamin
