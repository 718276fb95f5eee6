#pragma once
// What a run left in its directory, read again.
#include "model/model.hpp"
#include "results/summary.hpp"
#include "results/table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// A table that a run wrote. Numbers come back to the last bit, whole ones as int; the columns label, parent, stage, status and
/// what are text. A last row that is not whole, of a run that was stopped, is left out. Throws InputError if there is no such file.
Table read_table(const std::string& file);

/// One state of states/ or frames/.
struct StoredState {
  std::string label;                   // "branch:1"; "" of a frame
  int row = -1;                        // of the path, or −1: of none
  std::string file;                    // states/LABEL.data, frames/STEP.data, or of a motion frames/STEP.csv
};

struct StoredRun {
  std::string directory;
  bool in_time = false;                // then `path` is trajectory.csv
  Table path, events, contacts, modes, curve, landscape;   // empty where the study has none
  std::optional<Summary> summary;      // none: the run did not end
  std::string version;                 // of the program that ran
  std::vector<StoredState> states;     // in the order of their rows, then the nodes of a landscape; of a study of modes the equilibrium alone
};

/// Reads the directory of one run. Throws InputError if it is none, or if a file in it cannot be understood.
StoredRun read_run(const std::string& directory);

/// Whether the run in a directory has come to its end, whatever that was: its summary says so.
bool has_ended(const std::string& directory);

/// The directory itself if it is that of a run (it holds a resolved.toml), of a sweep its runs in their order. Throws InputError if
/// it is neither.
std::vector<std::string> runs_in(const std::string& directory);

/// Positions, poses and load factor of a stored state of this model (see input/state_supplement.hpp); without tails. Throws InputError if
/// the file cannot be understood or holds other particles.
State read_state(const StoredState& stored, const Model& model);

/// Displacements of a stored state's null vectors, or of a mode: 3 × particles, then 2 × bodies columns, motion [length] and
/// turn [rad], each. `file` is states/LABEL.modes.csv or modes/mode-K.csv; nothing if it is not there.
std::vector<Field> read_displacements(const std::string& file, const Model& model);

/// The name of the file of a label's state, without folder and end: "branch:1" → "branch-1".
std::string file_name_of(std::string label);

/// states/LABEL.modes.csv of states/LABEL.data.
std::string null_vectors_file(const std::string& data_file);

}  // namespace elamin
