#pragma once
// Particles, bonds, angles and bodies from a LAMMPS data file.
#include "input/keys.hpp"
#include "input/mistakes.hpp"
#include "lammps/reading.hpp"

namespace elamin {

struct LammpsTable {
  TablePlace place;
  std::string data, bodies, atom_style, input;
  std::optional<std::vector<std::string>> ignore;
  std::optional<std::vector<std::vector<double>>> bond_coefficients, angle_coefficients;
  std::vector<std::pair<std::string, int>> labels;   // of the atom types of `data`, groups too; read from the file
  bool operator==(const LammpsTable&) const = default;
};

void describe(Keys& keys, LammpsTable& t);

/// How the files are to be read.
LammpsReading reading_of(const LammpsTable& t);

/// Mistakes of its lists; takes the labels of the types from the file.
void check_lammps(LammpsTable& t, Mistakes& mistakes);

}  // namespace elamin
