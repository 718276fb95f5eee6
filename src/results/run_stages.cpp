#include "results/run_stages.hpp"

#include "input/staged_structure.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace elamin {

namespace {

std::string stage_name(const StoredRun& run, const StoredState& stored) {
  const int column = run.path.column("stage");
  if (column < 0 || stored.row < 0) return "";
  return csv_text(run.path.rows[stored.row][column]);
}

std::vector<StoredState> states_of(const StoredRun& run, const std::string& stage) {
  std::vector<StoredState> own;
  for (const StoredState& s : run.states)
    if (stage_name(run, s) == stage) own.push_back(s);
  return own;
}

// Bonds that are left stand in the order of all.
std::vector<int> bonds_left(const Model& model, const Model& all) {
  std::vector<int> left;
  for (std::size_t b = 0; b < all.bonds.size() && left.size() < model.bonds.size(); ++b)
    if (model.bonds[left.size()].particles == all.bonds[b].particles) left.push_back(static_cast<int>(b));
  return left;
}

}  // namespace

std::vector<RunStage> stages_of(const StoredRun& run, const Problem& problem, Model& all) {
  Stages stages(problem);
  std::string unclear;
  if (problem.stages.empty()) {
    Stage only = stages.enter(unclear);
    only.scaling = scalings_in(std::as_const(all));
    return {{std::move(only), all, std::vector<bool>(all.particles()), bonds_left(all, all)}};
  }
  const bool connects = connects_before(problem, stages.count() - 1);
  State now = all.start;
  std::vector<RunStage> list;
  for (int k = 0; k < stages.count(); ++k) {
    Stage stage = stages.enter(unclear);
    stages.leave(stage.path.to);
    const std::vector<StoredState> own = states_of(run, stage.name);
    if (own.empty()) continue;                                   // of a run that was taken up behind it, or did not come to it
    const auto supplement = read_supplement(own.front().file);
    if (supplement && supplement->stage && supplement->stage->scaling.size() == stage.scaling.size()) stage.scaling = supplement->stage->scaling;
    std::ignore = connect_in(problem, k, all, now);
    Model model = model_in(problem, stage, all, now);
    std::vector<int> bonds = bonds_left(model, all);
    list.push_back({std::move(stage), std::move(model), absent_in(problem, k, all), std::move(bonds)});
    if (connects) now = read_state(own.back(), all);
  }
  return list;
}

const RunStage& stage_of(const std::vector<RunStage>& stages, const StoredRun& run, const StoredState& stored) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const RunStage& s) { return s.stage.name == stage_name(run, stored); });
  return found == stages.end() ? stages.front() : *found;
}

}  // namespace elamin
