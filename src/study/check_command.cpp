#include "study/commands.hpp"

#include "core/memory.hpp"
#include "core/say.hpp"
#include "input/lammps.hpp"
#include "solve/ordering.hpp"
#include "study/describe.hpp"
#include "study/prepare.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace elamin {

namespace {

// Of each stage: from where to where, and what the load factor moves.
std::string describe_stages(const Problem& problem) {
  if (problem.stages.empty()) return "";
  std::string text;
  const std::vector<Condition> conditions = conditions_of(problem);
  Stages stages(problem);
  for (int k = 0; k < stages.count(); ++k) {
    std::string unclear, moved, off;
    const Stage stage = stages.enter(unclear);
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const auto add = [&](std::string& to) { to += (to.empty() ? "" : ", ") + conditions[i].label(); };
      if (!stage.in_force[i]) add(off);
      else if (stage.scaling[i].rate != 0 && moves(problem, conditions[i])) add(moved);
    }
    text += fmt::format("stage '{}': load factor {:.10g} to {:.10g}; it moves {}{}{}\n", stage.name, stage.path.from, stage.path.to,
                        moved.empty() ? "nothing" : moved, off.empty() ? "" : "; not in force: ", off);
    stages.leave(stage.path.to);
  }
  return text;
}

std::string describe_imperfection(const ImperfectionTable& t, double most) {
  std::string from;
  if (t.modes) from = fmt::format("modes {}{}{}", fmt::join(*t.modes, ", "), t.run.empty() ? "" : " of ", t.run);
  else if (t.random) from = fmt::format("random, seed {}", t.seed.value_or(0));
  else from = fmt::format("{:.10g} times what {} has beside the perfect shape", t.scale.value_or(1), t.state);
  return fmt::format("imperfection: {}; particles are moved by {:.10g} at most, {}\n", from, most, t.stress_free ? "and at rest so" : "and strained so");
}

constexpr int told_from = 100'000;               // free dofs from which on memory may matter

}  // namespace

std::string describe(const Problem& problem, const Model& model) {
  Energy energy(model);
  std::string text = fmt::format("{} particles, {}{} bonds, {} angles, {} free dofs{}\n", model.particles(),
                                 model.bodies.empty() ? "" : fmt::format("{} bodies, ", model.bodies.size()), model.bonds.size(),
                                 model.angles.size(), energy.dofs(), problem.plane.empty() ? "" : ", plane " + problem.plane);
  if (energy.dofs() >= told_from) {
    const FactorSize factor = factor_size(energy.hessian());
    text += fmt::format("a factor of the Hessian takes about {:.2g} GB and {:.2g} operations; {:.2g} GB are free{}\n", factor.bytes() / 1e9, factor.operations,
                        free_memory() / 1e9, factor.bytes() > free_memory() ? ": it goes on disk" : "");
  }
  if (problem.constants) {
    std::vector<std::string> numbers;
    for (const auto& [name, value] : problem.constants->numbers) numbers.push_back(fmt::format("{} = {:.10g}", name, value));
    text += fmt::format("constants: {}\n", fmt::join(numbers, ", "));
  }
  text += describe_structures(problem, model, energy.kinematics());
  for (const std::string& note : problem.notes) text += "note: " + note + "\n";
  for (const std::string& note : lammps_remarks(problem).notes) text += "note: " + note + "\n";
  if (problem.imperfection) text += describe_imperfection(*problem.imperfection, model.imperfection);
  text += describe_conditions(problem, model);
  // An equilibrium is sought from the state as built; supports and walls move from there.
  const bool built = problem.study == StudyType::equilibrium && !model.restart;
  const State start = built ? model.start : starting_state(problem, energy);
  text += describe_contacts(model, energy, start);
  for (const std::string& warning : warnings(problem, model, energy, start)) text += "warning: " + warning + "\n";
  for (const Group& g : model.groups)
    text += fmt::format("group '{}': {} particles{}\n", g.name, g.particles.size(), g.bodies.empty() ? "" : fmt::format(", {} bodies", g.bodies.size()));
  text += describe_motions(model);
  if (problem.in_time()) text += describe_timestep(energy, starting_state(problem, energy), *problem.dynamics.timestep);
  return text + describe_stages(problem);
}

void check_command(const std::string& file, const std::vector<Setting>& settings) {
  const PreparedRuns prepared = prepare_runs(file, settings);
  const std::vector<PreparedRun>& runs = prepared.runs;
  const Problem& problem = runs.front().problem;
  say("{}: {}\n{}", problem.file, problem.title.empty() ? "(no title)" : problem.title, describe(problem, runs.front().model));
  if (prepared.bisection) say("a sweep that halves; its first run is shown\n");
  else if (problem.refine)
    for (std::size_t k = 0; k < runs.size(); ++k) {
      std::vector<std::string> keys;
      for (const Setting& s : runs[k].swept) keys.push_back(s.key + " = " + s.value);
      say("level {}: {} particles: {}\n", k + 1, runs[k].model.particles(), fmt::join(keys, ", "));
    }
  else if (runs.size() > 1) say("a sweep of {} runs; the first one is shown\n", runs.size());
}

}  // namespace elamin
