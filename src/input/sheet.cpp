#include "input/sheet.hpp"

#include "input/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr Word<SheetShape> sheet_words[]{
    {"rectangle", SheetShape::rectangle}, {"circle", SheetShape::circle}, {"cylinder", SheetShape::cylinder}};

/// K = √3/4 E t and B = E t³/(8√3) of the triangular lattice. Source: Guerra 2021, equations (21), (27).
double sheet_bond_stiffness(double E, double t) { return std::sqrt(3.0) / 4 * E * t; }
double sheet_angle_stiffness(double E, double t) { return E * t * t * t / (8 * std::sqrt(3.0)); }

}  // namespace

void describe(Keys& keys, SheetTable& t) {
  keys.about("A triangular lattice of particles: a plate, or a tube.");
  keys.name("name", t.name, "its name, which is a group too");
  keys.may("from_stage", t.from_stage, "the stage it is there from; by default from the start");
  if (!keys.word("shape", t.shape, sheet_words, "its outline")) return keys.skip_the_rest();   // other keys belong to other shapes
  const auto radius = [&] { keys.must("radius", t.radius, "of the circle or the cylinder [length]", range::positive); };
  keys.either("shape", {{{"rectangle"}, "a rectangle", t.shape == SheetShape::rectangle,
                         [&] { keys.must("size", t.size, "the two sides of a rectangle [length]", range::positive); }},
                        {{"circle"}, "a circle", t.shape == SheetShape::circle, radius},
                        {{"cylinder"}, "a cylinder", t.shape == SheetShape::cylinder, [&] {
                           radius();
                           keys.must("height", t.height, "of the cylinder [length]", range::positive);
                         }}});
  keys.may("center", t.center, "its middle");
  keys.may("normal", t.normal, "across the plate, along a cylinder");
  keys.may("lattice_angle", t.lattice_angle, "of a row of the lattice against the first side [degrees]");
  keys.must("spacing", t.spacing, "distance of neighbours [length]", range::positive);
  keys.may("diameter", t.diameter, "of the particles, for contact and mass [length]; by default the spacing", range::positive);
  describe_stiffness(keys, t, "t in the stiffnesses [length]; by default the spacing");
  describe_own_values(keys, t.values, false);
}

void check(SheetTable& t, Mistakes& mistakes) {
  check_direction(t.place, "normal", t.normal, mistakes);
  check_stiffness(t.place, mistakes);
}

std::optional<Sheet> built(const SheetTable& table, Mistakes& mistakes) {
  const double thickness = table.thickness.value_or(table.spacing), E = table.youngs_modulus.value_or(0);
  Sheet s;
  s.name = table.name, s.shape = table.shape;
  s.center = table.center, s.normal = table.normal;
  s.size = table.size.value_or(s.size), s.radius = table.radius.value_or(0), s.height = table.height.value_or(0);
  s.lattice_angle = table.lattice_angle * (pi / 180);
  s.spacing = table.spacing, s.rest_length = table.rest_length.value_or(0);
  s.diameter = table.diameter.value_or(table.spacing), s.density = table.density.value_or(0), s.youngs_modulus = E;
  s.bond_stiffness = table.bond_stiffness.value_or(sheet_bond_stiffness(E, thickness));
  s.angle_stiffness = table.angle_stiffness.value_or(sheet_angle_stiffness(E, thickness));
  s.as_built = table.rest.as_built, s.rest = rest_angle(table.rest, pi);
  const double reach = std::max({s.size[0], s.size[1], s.radius, s.height});
  if (lost(table.place, "spacing", s.spacing, s.center.cwiseAbs().maxCoeff() + reach, mistakes)) return std::nullopt;
  if (!stiff(table.place, s.bond_stiffness, s.angle_stiffness, mistakes)) return std::nullopt;
  const int particles = sheet_particles(s);
  if (particles > most_particles)
    mistakes.add(table.place,
                 fmt::format("has more particles than can be handled, {}; make it smaller or its spacing larger", most_particles));
  else if (particles == 0)
    mistakes.add(table.place, "radius", fmt::format("is too small for the spacing: once around is {:.3g} spacings, and a cylinder closes with three",
                                                    2 * pi * s.radius / s.spacing));
  else if (particles == 1)
    mistakes.add(table.place, "spacing", "is too large: the sheet has one particle; it needs two at least");
  else
    return s;
  return std::nullopt;
}

}  // namespace elamin
