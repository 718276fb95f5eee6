#pragma once
#include "input/problem.hpp"
#include "input/settings.hpp"
#include "study/run.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// What is understood of a problem: particles, dofs, stiffnesses, effective lengths between the clamps, contact laws, walls and
/// overlaps, groups, rigid motions left free, stages; a line each.
std::string describe(const Problem& problem, const Model& model);

/// `elamin check`: reads and checks a problem file and all runs of its sweep, and prints what was understood of the first one.
/// Throws InputError with every mistake.
void check_command(const std::string& file, const std::vector<Setting>& settings);

/// `elamin energy`: energies and forces of the state that the file starts from, nothing solved.
/// Prints a table, or JSON; writes the forces −∂U/∂x of everything, held or not, plus the drag −γv of a moving state,
/// to `forces_file` if that is not empty: particles id,fx,fy,fz in id order; bodies, if there are any, to a second file that ends
/// in .bodies.csv: id,fx,fy,fz,tx,ty,tz, torques about their places. Bodies that follow LAMMPS's rules have the energy that it
/// reports, and forces with the damping of a moving state. 0, or 2 with a sentence where
/// the energy is not finite. Throws InputError as reading does.
struct EnergyOptions {
  std::string file;
  std::vector<Setting> settings;
  bool json = false;
  std::string forces_file;
  std::optional<double> load_factor;   // default: where the study starts; 1 without a path
};
int energy_command(const EnergyOptions& options);

struct ImportOptions {
  std::string script, output;                   // "": the script's name as problem.toml
  bool dynamics = false, correct = false, skip = false, include_anywhere = false, force = false, quiet = false;
  std::string compat;                           // "" or "lwp"
  std::vector<std::string> after;
};

/// `elamin import`: a LAMMPS input script to a problem file with a data file beside it; of a script that begins anew several
/// times problem-1.toml, problem-2.toml, … Prints what was taken, ignored and not understood, and what is to know. Throws InputError with
/// all mistakes; then nothing is written.
void import_command(const ImportOptions& options);

/// `elamin export`: the problem's model and stages as a LAMMPS script, and beside it the data file that it reads (the script's name with
/// .data). Prints what was written. Throws InputError as reading does, and with everything at once that LAMMPS cannot say; then nothing
/// is written, unless `skip`: then that is left out, and the script says so.
struct ExportOptions {
  std::string file;
  std::vector<Setting> settings;
  std::string script;                      // "": the problem file's name with .lmp
  bool skip = false, force = false;        // force: write over files that it has not written, too
  int steps = 0;                           // of each stage's run, of a study of equilibria; 0: as many as seem enough
};
void export_command(const ExportOptions& options);

/// `elamin prove`: of a state that a run has stored, that near it there is exactly one equilibrium and how many negative eigenvalues its
/// Hessian has, as a theorem (see proof/theorem.hpp). Prints the bounds and writes DIR/proof.json, from which examples/check_proof.cpp
/// proves it again. 0, or 2 with a sentence where it is not proven. Throws InputError if there is no such run or state.
struct ProveOptions {
  std::string directory, at = "final";
  std::string file;                        // "": DIR/proof.json
};
int prove_command(const ProveOptions& options);

/// `elamin verify`: runs every file, each into its directory below `options.directory` if that is given, and prints one
/// line for every expectation. Returns the exit status: 3 if one is not met, else the worst of the runs.
int verify_command(const std::vector<std::string>& files, const RunOptions& options);

}  // namespace elamin
