#pragma once
#include "input/settings.hpp"

#include <string>
#include <vector>

namespace elamin {

/// `elamin export`: the problem's model and stages as a LAMMPS script, and beside it the data file that it reads (the script's name with
/// .data). Prints what was written. Throws InputError as reading does, and with everything at once that LAMMPS cannot say; then nothing
/// is written, unless `skip`: then that is left out, and the script says so.
struct ExportOptions {
  std::string file;
  std::vector<Setting> settings;
  std::string script;                      // "": the problem file's name with .lmp
  bool skip = false;
  int steps = 0;                           // of each stage's run, of a study of equilibria; 0: as many as seem enough
};
void export_command(const ExportOptions& options);

}  // namespace elamin
