#pragma once
// LAMMPS atom styles: which columns a line of the section Atoms has.
#include <optional>
#include <string>
#include <vector>

namespace elamin {

enum class AtomColumn { id, type, molecule, diameter, density, charge, bodyflag, mass, x, y, z };

/// Columns of an atom style, image flags left out. Nothing: not known; why not is written to *why (a sentence's end).
/// Source: LAMMPS manual, read_data; a hybrid has id type x y z, then every sub-style's own columns in order.
[[nodiscard]] std::optional<std::vector<AtomColumn>> atom_columns(const std::string& style, std::string* why);

}  // namespace elamin
