#pragma once
// What glued structures say of their stiffnesses.
#include "input/keys.hpp"
#include "laws/section.hpp"
#include "model/model.hpp"

namespace elamin {

struct StiffnessKeys {
  std::optional<double> thickness, youngs_modulus, density;
  std::optional<double> bond_stiffness, angle_stiffness, rest_length;
  Rest rest;
  bool operator==(const StiffnessKeys&) const = default;
};

/// Of a row of particles: a section, or EA and EI instead of it.
struct RowStiffnessKeys : StiffnessKeys {
  Section section = Section::cylinder;
  std::optional<double> axial_stiffness, bending_stiffness;
  bool operator==(const RowStiffnessKeys&) const = default;
};

inline constexpr Word<Section> section_words[]{{"cylinder", Section::cylinder}, {"square", Section::square}};

/// thickness: what it is by default.
void describe_stiffness(Keys& keys, StiffnessKeys& s, const char* thickness);
void describe_row_stiffness(Keys& keys, RowStiffnessKeys& s);

/// The key `values`, of a row of particles or another structure; see add_own_values.
void describe_own_values(Keys& keys, std::string& file, bool row);

/// Stiffnesses that follow from nothing are a mistake.
void check_stiffness(TablePlace& place, Mistakes& mistakes);
void check_row_stiffness(TablePlace& place, Mistakes& mistakes);

/// K = EA/(2 r₀) and B = EI/r₀ of a row whose rest length is in `bond`, of the section where nothing else is given.
void row_stiffness(const RowStiffnessKeys& s, double diameter, BondType& bond, AngleType& angle);

/// The rest angle in radians: π, exactly, if straight; `as_built` if that is asked for.
double rest_angle(const Rest& rest, double as_built);

/// Whether both are numbers to compute with; else that is told.
bool stiff(const TablePlace& place, double bond, double angle, Mistakes& mistakes);

/// Neighbours must be told apart by doubles, or every length is rounding: whether `length` is lost beside the farthest
/// coordinate; then it is told as a mistake.
bool lost(const TablePlace& place, const char* what, double length, double farthest, Mistakes& mistakes);

/// A direction that is zero is a mistake.
void check_direction(TablePlace& place, const char* key, const Vec3& direction, Mistakes& mistakes);

}  // namespace elamin
