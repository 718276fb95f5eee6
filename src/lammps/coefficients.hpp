#pragma once
// Coefficients of bonds and angles in a LAMMPS data file, by style.
#include "lammps/rows.hpp"

#include <optional>
#include <string>

namespace elamin {

/// Why a section with that comment behind its name cannot be read, or "". kind: "bond" or "angle".
std::string refused_style(const std::string& kind, const std::string& comment);

/// A row of "Bond Coeffs" or "Angle Coeffs"; the style is the one that the line names, else that of the section's
/// comment, else harmonic or cosine. Types may have labels. A mistake, also a type
/// above most_types, is noted in the lines.
[[nodiscard]] std::optional<CoefficientRow> coefficient_row(LammpsLines& lines, const DataLine& line, const std::string& kind,
                                              const std::string& comment, int most_types,
                                              const TypeLabels& labels);

}  // namespace elamin
