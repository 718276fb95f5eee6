#pragma once
// Particles, bonds, angles and bodies from LAMMPS data files, or all that an input script makes; the state that a path goes on from.
#include "input/keys.hpp"
#include "lammps/reading.hpp"

namespace elamin {

struct Document;
struct Model;

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

/// Takes particles, bonds, angles and bodies of [lammps] into the model, which is empty yet. False: they are not known;
/// why was told.
bool add_lammps(const Problem& problem, Model& model, Mistakes& mistakes);

/// What the files of [lammps] hold and the model has not, in sentences, and warnings of coefficients that were rounded. Reads them again.
struct LammpsRemarks { std::vector<std::string> notes, warnings; };
LammpsRemarks lammps_remarks(const Problem& problem);

/// Model::restart from path.start, a state of this model: positions, poses and in dynamics velocities, to the last bit where
/// LABEL.json stands beside. Without it the bodies are turned as their vertices tell.
void add_restart(const Problem& problem, Model& model, Mistakes& mistakes);

/// If [lammps] has `input`: the tables that `elamin import` makes of that script come before those of the file. What both have is the
/// file's: a key of the top or of a table such as [path]. With `particles_only`, which is true from then on, no tables come. Nothing is
/// written: the script's particles are in document.script. Does nothing the second time. Throws InputError with the script's mistakes, or
/// if it gives not one problem but several.
void take_lammps_input(Document& document);

}  // namespace elamin
