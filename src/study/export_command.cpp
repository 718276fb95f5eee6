#include "core/find.hpp"
#include "study/commands.hpp"

#include "core/error.hpp"
#include "core/say.hpp"
#include "core/text_file.hpp"
#include "dynamics/timestep.hpp"
#include "study/imperfection.hpp"
#include "input/read.hpp"
#include "input/staged_structure.hpp"
#include "input/stages.hpp"
#include "lammps/export.hpp"
#include "lammps/state.hpp"
#include "model/entities.hpp"
#include "results/run_directory.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace elamin {

namespace {

using Kind = ExportedStudy::Kind;

/// The masses that the data file gives: where no density is known it is 1.
Model with_masses(Model model) {
  for (double& d : model.density)
    if (!(d > 0)) d = 1;
  return model;
}

/// A step that is stable beside the bonds and angles, and in contacts that overlap by a thousandth of the smallest radius.
double step_for(const Model& model, Energy& energy, const State& state) {
  double step = timestep_limit(energy, state).advised();
  double modulus = 0;
  for (const PairContact& c : model.contacts) modulus = std::max(modulus, c.effective_modulus);
  for (const Wall& w : model.walls) modulus = std::max(modulus, w.effective_modulus);
  for (int p = 0; p < model.particles() && modulus > 0; ++p)
    if (const double r = model.diameter[p] / 2; r > 0) {
      const double stiffness = 2 * modulus * std::sqrt(r / 2 * r / 1000);   // 3/2 k √δ, k = 4/3 E √(r/2)
      step = std::min(step, 0.314 * std::sqrt(model.mass(p) / stiffness));
    }
  return std::isfinite(step) ? step : 1e-5;
}

/// Steps and drag of a stage: critical for the slowest bending of a row as long as the model, about 20 of its periods.
void let_it_settle(const Model& model, Energy& energy, const State& state, ExportedStudy& study) {
  study.timestep = step_for(model, energy, state);
  double mass = 0, spacing = 0;
  for (int p = 0; p < model.particles(); ++p) mass += model.mass(p) / model.particles();
  for (const Bond& b : model.bonds) spacing = std::max(spacing, (state.at(b.particles[1]) - state.at(b.particles[0])).hi.norm());
  if (spacing == 0) spacing = std::max(smallest_size(model), 1e-3 * sides_of(state).maxCoeff());
  const double row = std::clamp(spacing > 0 ? sides_of(state).maxCoeff() / spacing : 3.0, 3.0, 300.0);
  const double fastest = 0.314 / study.timestep;           // 2 π over 20 steps
  study.drag = 5 * mass * fastest / (row * row);
  study.steps = std::max(20000L, std::lround(400 * row * row));
}

}  // namespace

void export_command(const ExportOptions& options) {
  const Problem problem = read_problem(options.file, options.settings);
  Model all = with_masses(model_of(problem));
  Energy whole(all);
  ExportedStudy study;
  study.title = problem.title, study.source = std::filesystem::path(problem.file).filename().string();
  study.kind = problem.study == StudyType::energy ? Kind::energy : problem.in_time() ? Kind::motion : Kind::equilibria;
  study.start = starting_state(problem, whole);
  const bool path = problem.follows_path();
  if (path && (problem.path.method == PathMethod::arc_length || problem.path.when_unstable == WhenUnstable::follow))
    study.notes.push_back("LAMMPS does not follow unstable equilibria, as this study does: where one ends it falls to the next stable "
                          "one.");
  if (problem.study == StudyType::modes) study.notes.push_back("The study asks for modes; the script goes to the equilibrium.");

  Stages stages(problem);
  for (int k = 0; k < (path ? stages.count() : 1); ++k) {
    std::string unclear;
    const Stage stage = stages.enter(unclear);
    const double load_factor = starting_load_factor(problem);
    const std::vector<bool> absent = absent_in(problem, stage.number, all);
    if (connects_before(problem, stage.number) || contains(absent, true))
      study.refused.push_back(fmt::format("stage '{}': what is added or taken away as it begins", stage.name));
    const double from = !path ? load_factor : k == 0 ? load_factor : stage.path.from;
    study.stages.push_back({stage.name, model_in(problem, stage, all, study.start), from, path ? stage.path.to : load_factor});
    stages.leave(stage.path.to);
  }
  const Model& model = study.stages.front().model;
  if (study.kind == Kind::motion) {
    study.timestep = *problem.dynamics.timestep, study.steps = problem.dynamics.steps;
  } else if (study.kind == Kind::equilibria && model.bodies.empty()) {
    let_it_settle(all, whole, study.start, study);
    if (options.steps > 0) study.steps = options.steps;
  }

  const std::filesystem::path script = options.script.empty() ? std::filesystem::path(problem.file).filename().replace_extension(".lmp")
      : std::filesystem::path(options.script);
  const std::filesystem::path data = std::filesystem::path(script).replace_extension(".data");
  std::error_code error;
  std::vector<std::string> read = inputs_of(problem);
  read.push_back(problem.file);
  for (const std::string& own : read)
    for (const auto& file : {script, data})
      if (std::filesystem::equivalent(own, file, error))
        throw InputError(fmt::format("{}: is a file that the problem is read from; give another name, -o in.lmp", file.string()));
  const LammpsExport out = export_to_lammps(study, data.filename().string());
  if (!out.refused.empty() && (!options.skip || model.particles() == 0)) {
    std::vector<Mistake> all_of_them;
    for (const std::string& what : out.refused) all_of_them.push_back({problem.file, 0, 0, {}, "LAMMPS cannot have " + what});
    if (!options.skip) all_of_them.push_back({problem.file, 0, 0, {}, "--skip leaves this out"});
    throw InputError(all_of_them);
  }
  struct File { std::string name, text; };
  std::vector<File> files{{script.string(), out.script}};
  for (const auto& [name, text] : out.files) files.push_back({(script.parent_path() / name).string(), text});
  must_be_own(data.string(), "export", options.force);
  for (const File& f : files) must_be_own(f.name, "export", options.force);
  write_state(data.string(), out.written, study.start, (problem.title.empty() ? study.source : problem.title) + ", by elamin export");
  for (const File& f : files) write_text(f.name, f.text);
  say("written: {} and {}: {} particles, {} bonds, {} angles, {} {}\n", script.string(), data.string(), model.particles(),
             model.bonds.size(),
             model.angles.size(), study.stages.size(), study.stages.size() == 1 ? "run" : "runs");
  for (const std::string& what : out.refused) say("left out: {}\n", what);
}

}  // namespace elamin
