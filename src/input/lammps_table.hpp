#pragma once
// Particles, bonds, angles and bodies from a LAMMPS data file.
#include "input/keys.hpp"
#include "input/mistakes.hpp"
#include "lammps/reading.hpp"

namespace elamin {

/// What a LAMMPS input script gives besides tables.
struct ScriptReading {
  std::string particles;                             // as a data file
  std::vector<std::string> files, notes;             // that were read, the script first; what is to know
  bool operator==(const ScriptReading&) const = default;
};

struct LammpsTable {
  TablePlace place;
  std::string data, bodies, atom_style, input;
  bool particles_only = false;
  std::optional<ScriptReading> script;               // of `input`
  std::optional<std::vector<std::string>> ignore;
  std::optional<std::vector<std::vector<double>>> bond_coefficients, angle_coefficients;
  std::vector<std::pair<std::string, int>> labels;   // of the atom types of `data`, groups too; read from the file
  bool operator==(const LammpsTable&) const = default;
};

void describe(Keys& keys, LammpsTable& t);

/// Whether there is a file, or a script, with particles.
bool has_particles(const LammpsTable& t);
/// How the files are to be read.
LammpsReading reading_of(const LammpsTable& t);

/// Mistakes of its lists; takes the labels of the types from the file.
void check_lammps(LammpsTable& t, Mistakes& mistakes);

}  // namespace elamin
