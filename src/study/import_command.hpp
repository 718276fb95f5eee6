#pragma once
#include <string>
#include <vector>

namespace elamin {

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

}  // namespace elamin
