#include "study/refine.hpp"

#include "core/say.hpp"
#include "core/text_file.hpp"
#include "input/finer.hpp"
#include "input/read.hpp"
#include "results/columns.hpp"
#include "results/json.hpp"
#include "results/refinement.hpp"
#include "study/imperfection.hpp"
#include "study/sweep.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace elamin {
namespace {

/// The level whose spacing is the file's divided by `by`.
std::vector<Setting> level_of(const Document& document, const std::vector<Setting>& settings, const std::vector<OwnLaw>& own, const Problem& coarse,
                              const Model& model, int by) {
  Mistakes mistakes(document.file);
  std::vector<Setting> level, all = settings;
  const auto take = [&](const std::vector<Setting>& more) {
    mistakes.raise();
    for (std::vector<Setting>* list : {&level, &all}) list->insert(list->end(), more.begin(), more.end());
  };
  const RefineTable& refine = *coarse.refine;
  for (const std::string& key : refine.divide)
    for (const auto& [name, value] : coarse.constants->numbers)
      if (key == "constants." + name) take({{key, to_toml(value / by), refine.place}});
  take(finer_structure(coarse, model, by, mistakes));
  const Problem fine = read_problem(document, all);
  take(finer_loads(coarse, model, fine, model_of(fine, own), by, mistakes));
  return level;
}

/// Ends of the path or of a stage are compared where all levels end at one event or at one load factor: where a path ends by its number of points, or closes to a
/// loop, is a matter of its steps.
void leave_out_ends(const std::vector<RunTables>& runs, const std::string& at, RefinedValues& refined) {
  constexpr double same = 1e-12;
  if (std::ranges::find(refined.values, at, &RefinedValue::at) == refined.values.end()) return;
  std::set<std::string> labels;
  std::vector<double> ends;
  for (const RunTables& run : runs) {
    std::string why;
    const Row& last = run.path->rows.back();
    labels.insert(at == "final" ? csv_text(last[run.path->column("label")]) : at);
    ends.push_back(value_at("lambda", at, run, why).value_or(0));
  }
  const auto [least, most] = std::ranges::minmax(ends);
  if ((labels.size() == 1 && is_event(*labels.begin())) || most - least <= same * std::max(std::abs(least), std::abs(most))) return;
  std::erase_if(refined.values, [&](const RefinedValue& v) { return v.at == at; });
  refined.remarks.push_back(fmt::format("{} is not at one load factor, and not compared: the levels end at {:.10g}", at, fmt::join(ends, ", ")));
}

}  // namespace

std::vector<std::vector<Setting>> levels_of(const Document& document, const std::vector<Setting>& settings, const std::vector<OwnLaw>& own) {
  const Problem coarse = read_problem(document, settings);
  const Model model = model_of(coarse, own);
  std::vector<int> finer{1};
  while (static_cast<int>(finer.size()) < coarse.refine->levels) finer.push_back(finer.back() * coarse.refine->by);
  if (const double most = static_cast<double>(model.particles()) * finer.back(); most > most_particles) {
    Mistakes mistakes(document.file);
    mistakes.add(coarse.refine->place, "levels", fmt::format("would have rows of {:.2g} particles at the end; at most {} are allowed", most, most_particles));
    mistakes.raise();
  }
  std::vector<std::vector<Setting>> levels(finer.size());
  for (std::size_t k = finer.size(); k-- > 0;) levels[k] = level_of(document, settings, own, coarse, model, finer[k]);   // what has no place is told of the finest
  // What is the same at all levels stays as the file has it, but for what else would follow from the spacing.
  std::map<std::string, std::set<std::string>> values;
  for (const std::vector<Setting>& level : levels)
    for (const Setting& s : level) values[s.key].insert(s.value);
  for (std::vector<Setting>& level : levels)
    std::erase_if(level, [&](const Setting& s) { return values[s.key].size() == 1 && !s.key.ends_with(".thickness") && !s.key.ends_with(".diameter"); });
  return levels;
}

std::vector<Verdict> finish_refinement(const PreparedRuns& prepared, const std::vector<std::optional<SingleResult>>& results, ResultsDirectory& directory,
                                       bool quiet) {
  const PreparedRun& first = prepared.runs.front();
  std::vector<RunTables> tables;
  for (const std::optional<SingleResult>& r : results) tables.push_back({&r->path, &r->events});
  std::vector<ExpectTable> expected = first.together;
  expected.insert(expected.end(), first.problem.expect.begin(), first.problem.expect.end());
  RefinedValues refined = refined_values(first.problem, tables, expected);
  for (std::size_t k = 0; k < results.size(); ++k)
    if (results[k]->status != Status::converged) {
      std::erase_if(refined.values, [](const RefinedValue& v) { return v.at == "final"; });
      refined.remarks.push_back(fmt::format("level {} ends early, and its end is not compared: {}", k + 1, results[k]->why));
    }
  leave_out_ends(tables, "final", refined);
  for (const StageTable& s : first.problem.stages) leave_out_ends(tables, s.name, refined);
  Json all{{"by", first.problem.refine->by}, {"levels", Json::array()}};
  for (std::size_t k = 0; k < prepared.runs.size(); ++k) {
    const PreparedRun& run = prepared.runs[k];
    Json level{{"run", run_name(k + 1, prepared.runs.size(), run.swept)}, {"particles", run.model.particles()}, {"settings", Json::object()}};
    for (const Setting& s : run.swept) level["settings"][s.key] = s.value;
    all["levels"].push_back(std::move(level));
  }
  all.update(refined_json(refined));
  write_text(directory.file("refine.json"), file_text(all));
  write_csv(directory.file("refine.csv"), refined_table(refined, tables.size()));
  if (!quiet) say("{}", closing_refined(refined));
  std::vector<Verdict> verdicts;
  for (const ExpectTable& e : first.together)
    if (e.continuum) verdicts.push_back(check_continuum(first.problem, e, refined));
  return verdicts;
}

}  // namespace elamin
