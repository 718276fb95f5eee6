#pragma once
// The stages that the states of a run are of, and what was there and in force in each.
#include "input/stages.hpp"
#include "results/stored_run.hpp"

#include <vector>

namespace elamin {

struct RunStage {
  Stage stage;                         // with the amounts of conditions that its states store
  Model model;                         // as it was then
  std::vector<bool> absent;            // of all particles, then bodies: not there yet, or gone
  std::vector<int> bonds;              // which of all bonds those of `model` are, ascending
};

/// The stages of a run up to the last one that it has states of; one if it has no stages. Connections are made where the stage
/// before has ended, and join `all`, the model as it was built. Throws InputError if that state cannot be read.
std::vector<RunStage> stages_of(const StoredRun& run, const Problem& problem, Model& all);

/// The one that a state is of.
const RunStage& stage_of(const std::vector<RunStage>& stages, const StoredRun& run, const StoredState& stored);

}  // namespace elamin
