#pragma once
// The sections of a LAMMPS data file as rows, before they are held against each other.
#include "core/types.hpp"
#include "lammps/bodies.hpp"
#include "lammps/lines.hpp"
#include "lammps/reading.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

// LAMMPS atom styles: which columns a line of the section Atoms has.

enum class AtomColumn { id, type, molecule, diameter, density, charge, bodyflag, mass, x, y, z };

/// Columns of an atom style, image flags left out. Nothing: not known; why not is written to *why (a sentence's end).
/// Source: LAMMPS manual, read_data; a hybrid has id type x y z, then every sub-style's own columns in order.
[[nodiscard]] std::optional<std::vector<AtomColumn>> atom_columns(const std::string& style, std::string* why);

struct AtomRow {
  int line, id, type, molecule;
  double diameter, density;
  Vec3 position;
  bool is_body = false;
  double mass = 0;                                                 // of a body
};
struct VelocityRow { int line, id; Vec3 velocity, angular_velocity; bool long_row = false; };   // of bodies the angular momentum; four or seven columns
struct CoefficientRow { int line, type; double stiffness, rest; int digits = 0; };   // rest length, or rest angle [rad]; digits written
using TypeLabels = std::map<std::string, int, std::less<>>;      // types from 1
struct MassRow { int line, type; double mass; };
struct TopologyRow { int line, type; std::array<int, 3> id, column; };   // of a bond the third is not used

/// Everything a file says, line by line; each row's numbers are finite and within the ranges of the header.
struct LammpsRows {
  struct Section { int line = 0, rows = 0; bool sound = true; };   // line of its keyword; sound: all rows could be read
  std::map<std::string, int> counts;                               // "atoms", "bond types", …
  std::map<std::string, Section> sections;
  Vec3 lo = Vec3::Constant(-0.5), hi = Vec3::Constant(0.5), tilt = Vec3::Zero();
  std::vector<AtomRow> atoms;
  std::vector<std::array<int, 3>> images;                          // of every atom row
  std::vector<VelocityRow> velocities;
  std::vector<CoefficientRow> bond_coefficients, angle_coefficients;
  std::vector<MassRow> masses;
  std::vector<TopologyRow> bonds, angles;
  std::vector<BodyRow> bodies;
  std::map<std::string, TypeLabels> labels;                        // of "atom", "bond" and "angle"
  std::vector<std::string> passed_over;                            // sections that were not asked to be
  int most_digits = 0;                                             // of K, r₀ and B, without zeros at the end
  bool charged = false;                                            // a charge is not 0

  int count(const std::string& what) const {
    const auto it = counts.find(what);
    return it == counts.end() ? 0 : it->second;
  }
  bool sound(const std::string& section) const {
    const auto it = sections.find(section);
    return it != sections.end() && it->second.sound;
  }
};

/// Reads all lines; mistakes are noted there.
LammpsRows read_lammps_rows(LammpsLines& lines, const LammpsReading& how);

/// Word i as a type from 1 to most, or as the label of one; else notes a mistake.
std::optional<int> type_in(LammpsLines& lines, const DataLine& line, std::size_t i, const std::string& key, int most,
                           const TypeLabels& labels);

// Coefficients of bonds and angles in a LAMMPS data file, by style.

/// Why a section with that comment behind its name cannot be read, or "". kind: "bond" or "angle".
std::string refused_style(const std::string& kind, const std::string& comment);

/// A row of "Bond Coeffs" or "Angle Coeffs"; the style is the one that the line names, else that of the section's
/// comment, else harmonic or cosine. Types may have labels. A mistake, also a type
/// above most_types, is noted in the lines.
[[nodiscard]] std::optional<CoefficientRow> coefficient_row(LammpsLines& lines, const DataLine& line, const std::string& kind,
                                              const std::string& comment, int most_types,
                                              const TypeLabels& labels);

}  // namespace elamin
