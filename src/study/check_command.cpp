#include "study/check_command.hpp"

#include "problem/sweep.hpp"
#include "study/describe.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

namespace elamin {

namespace {

void print_model(const Problem& problem, const Model& model) {
  Energy energy(model);
  fmt::print("{}: {}\n", problem.file, problem.title.empty() ? "(no title)" : problem.title);
  fmt::print("{} particles, {} bonds, {} angles, {} free dofs{}\n", model.particles(), model.bonds.size(), model.angles.size(), energy.dofs(),
             problem.plane.empty() ? "" : ", plane " + problem.plane);
  fmt::print("{}", describe_structures(problem, model, energy.kinematics()));
  fmt::print("{}", describe_conditions(problem, model));
  // An equilibrium is sought from the state as built; supports and walls move from there.
  const bool built = problem.study == StudyType::equilibrium && !model.restart;
  fmt::print("{}", describe_contacts(model, energy, built ? model.start : starting_state(problem, energy)));
  for (const Group& g : model.groups) fmt::print("group '{}': {} particles\n", g.name, g.particles.size());
  fmt::print("{}", describe_motions(model));
}

}  // namespace

void check_command(const std::string& file, const std::vector<Setting>& settings) {
  const PreparedRuns prepared = prepare_runs(file, settings);
  const std::vector<PreparedRun>& runs = prepared.runs;
  print_model(runs.front().problem, runs.front().model);
  if (prepared.bisection) fmt::print("a sweep that halves; its first run is shown\n");
  else if (runs.size() > 1) fmt::print("a sweep of {} runs; the first one is shown\n", runs.size());
}

}  // namespace elamin
