#include "input/conditions.hpp"

#include <algorithm>

namespace elamin {

std::vector<Condition> conditions_of(const Problem& problem) {
  std::vector<Condition> all;
  const auto add = [&](const std::string& kind, const auto& tables) {
    for (std::size_t i = 0; i < tables.size(); ++i) all.push_back(condition_of(kind, tables, i));
  };
  add("support", problem.supports), add("load", problem.loads), add("gravity", problem.gravity);
  add("pressure", problem.pressures), add("change", problem.changes), add("wall", problem.walls);
  return all;
}

std::vector<std::string> labels_of(const std::vector<Condition>& conditions) {
  std::vector<std::string> labels;
  for (const Condition& c : conditions) labels.push_back(c.label());
  return labels;
}

int find_condition(const std::vector<Condition>& conditions, const std::string& word) {
  const auto found = std::find_if(conditions.begin(), conditions.end(), [&](const Condition& c) { return c.answers_to(word); });
  return found == conditions.end() ? -1 : static_cast<int>(found - conditions.begin());
}

Scaling scaling_of(const Problem& problem, const Condition& condition) {
  const std::vector<std::string>& chosen = problem.path.parameter;
  if (chosen.empty()) return condition.constant ? Scaling::constant() : Scaling();
  const bool named = std::any_of(chosen.begin(), chosen.end(), [&](const std::string& word) { return condition.answers_to(word); });
  return named ? Scaling() : Scaling::constant();
}

std::vector<double> load_factors(const Problem& problem) {
  const PathTable& path = problem.path;
  if (!problem.follows_path() || path.place.broken) return {0, 1};
  std::vector<double> all{path.from, path.to, path.start_lambda.value_or(path.from)};
  for (const auto& end : {path.lowest, path.highest})
    if (end) all.push_back(*end);
  for (const StageTable& s : problem.stages)
    for (const auto& end : {s.from, s.to})
      if (end) all.push_back(*end);
  return all;
}

namespace {

template <class M, class Take> void each_scaling(M& model, const Take& take) {
  const auto go = [&](auto& list) {
    for (auto& element : list) take(element.scaling);
  };
  go(model.supports), go(model.loads), go(model.gravity), go(model.pressures), go(model.changes), go(model.walls);
}

}  // namespace

std::vector<Scaling*> scalings_in(Model& model) {
  std::vector<Scaling*> all;
  each_scaling(model, [&](Scaling& s) { all.push_back(&s); });
  return all;
}

std::vector<Scaling> scalings_in(const Model& model) {
  std::vector<Scaling> all;
  each_scaling(model, [&](const Scaling& s) { all.push_back(s); });
  return all;
}

}  // namespace elamin
