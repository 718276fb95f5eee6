#pragma once
// What a script has built and run, as problem files.
#include "lammps/script/interpreter.hpp"

#include <string>
#include <vector>

namespace elamin::script {

struct TranslationOptions {
  bool dynamics = false;                        // motion in time, step for step, instead of equilibria
  bool correct = false;                         // sheets of LAMMPSStructures get the bending stiffness of their derivation
  bool compat = false;                          // … or keep the one they have, without a note
};

/// A problem file and the data file beside it, which it calls data_name.
struct Translated {
  std::string toml, data;
  std::vector<Note> notes;
};

/// A pass as a problem: what is glued goes to the data file, what is in force in each run becomes tables, several runs stages.
/// Throws InputError for what no problem file can say.
Translated translated(const Reading& reading, const Pass& pass, const TranslationOptions& options, const std::string& data_name);

/// With dynamics one problem a run, each going on from the last state of the one before, which lies in the folder of that name
/// (`folders`, one for each run but the last).
std::vector<Translated> in_time(const Reading& reading, const Pass& pass, const TranslationOptions& options,
                                const std::vector<std::string>& data_names, const std::vector<std::string>& folders);

}  // namespace elamin::script
