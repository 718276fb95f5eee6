#include "input/stiffness.hpp"

#include "input/keys.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {

void describe_stiffness(Keys& keys, StiffnessKeys& s, const char* thickness) {
  keys.may("thickness", s.thickness, thickness, range::positive);
  keys.may("youngs_modulus", s.youngs_modulus, "E [force/length²], from which the stiffnesses follow that are not given", range::positive);
  keys.may("density", s.density, "of the particles, which are spheres [mass/length³]; gravity and dynamics need it", range::positive);
  keys.may("bond_stiffness", s.bond_stiffness, "K of the bonds, U = K (r − r₀)² [force/length]", range::positive);
  keys.may("angle_stiffness", s.angle_stiffness, "B of the angles, U = B (1 − cos(θ − θ₀)) [energy]; 0: there are none, a chain", range::not_negative);
  keys.may("rest_length", s.rest_length, "r₀ of the bonds [length]; by default their length as built", range::positive);
  keys.may("rest", s.rest, "θ₀ of the angles", range::degrees);
}

void describe_row_stiffness(Keys& keys, RowStiffnessKeys& s) {
  describe_stiffness(keys, s, "t of the section in the stiffnesses [length]; by default the diameter");
  keys.may("axial_stiffness", s.axial_stiffness, "EA [force] instead of a bond stiffness: K = EA/(2 r₀)", range::positive);
  keys.may("bending_stiffness", s.bending_stiffness, "EI [force·length²] instead of an angle stiffness: B = EI/r₀", range::not_negative);
  keys.at_most_one({"bond_stiffness", "axial_stiffness"});
  keys.at_most_one({"angle_stiffness", "bending_stiffness"});
}

void describe_own_values(Keys& keys, std::string& file, bool row) {
  keys.may_file("values", file,
                row ? "a table of commas, a row a particle, whose first line names columns of diameter, density, bond_stiffness and rest_length (of the "
                      "bond to the next particle), angle_stiffness (of the angle over it); an empty cell: as by the other keys"
                    : "a table of commas, a row a particle, whose first line names columns of diameter and density; an empty cell: as by the other keys");
}

void check_row_stiffness(TablePlace& place, Mistakes& mistakes) {
  const bool bonds = place.written("bond_stiffness") || place.written("axial_stiffness");
  const bool angles = place.written("angle_stiffness") || place.written("bending_stiffness");
  if (!place.written("youngs_modulus") && !(bonds && angles))
    mistakes.add(place, "youngs_modulus",
                 "is missing; it must be a positive number, or give axial_stiffness and bending_stiffness, or "
                 "bond_stiffness and angle_stiffness");
}

void check_stiffness(TablePlace& place, Mistakes& mistakes) {
  if (!place.written("youngs_modulus") && !(place.written("bond_stiffness") && place.written("angle_stiffness")))
    mistakes.add(place, "youngs_modulus", "is missing; it must be a positive number, or give bond_stiffness and angle_stiffness");
}

void row_stiffness(const RowStiffnessKeys& s, double diameter, BondType& bond, AngleType& angle) {
  const double E = s.youngs_modulus.value_or(0), t = s.thickness.value_or(diameter), q = bond.rest_length;
  bond.stiffness = s.bond_stiffness ? *s.bond_stiffness : s.axial_stiffness ? *s.axial_stiffness / (2 * q) : bond_stiffness(s.section, E, t, q);
  angle.stiffness = s.angle_stiffness ? *s.angle_stiffness : s.bending_stiffness ? *s.bending_stiffness / q : angle_stiffness(s.section, E, t, q);
}

double rest_angle(const Rest& rest, double as_built) {
  if (rest.as_built) return as_built;
  return rest.degrees == 180 ? pi : rest.degrees * pi / 180;
}

namespace {

/// An angle stiffness of zero that is written means that there are no angles; one that came out is lost.
bool no_angles(const TablePlace& place, const std::string& what) {
  return what == "angle" && (place.written("angle_stiffness") || place.written("bending_stiffness"));
}

}  // namespace

bool stiff(const TablePlace& place, double bond, double angle, Mistakes& mistakes) {
  for (const auto& [name, value] : {std::pair("bond", bond), {"angle", angle}})
    if (!std::isnormal(value) && !(value == 0 && no_angles(place, name))) {
      mistakes.add(place, fmt::format("its {} stiffness, {}, is beyond what numbers can hold", name, value));
      return false;
    }
  return true;
}

bool lost(const TablePlace& place, const char* what, double length, double farthest, Mistakes& mistakes) {
  if (!std::isfinite(farthest))
    mistakes.add(place, "its size is beyond what numbers can hold");
  else if (length <= 1e-12 * farthest)
    mistakes.add(place, fmt::format("its {}, {}, is lost beside its coordinates, {}; place it nearer to the origin",
                                    what, length, farthest));
  else
    return false;
  return true;
}

void check_direction(TablePlace& place, const char* key, const Vec3& direction, Mistakes& mistakes) {
  if (direction.isZero(0)) mistakes.add(place, key, "is zero; a direction has a length");
}

}  // namespace elamin
