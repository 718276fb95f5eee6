#include "study/single.hpp"

#include "core/interrupt.hpp"
#include "core/say.hpp"
#include "core/text_file.hpp"
#include "core/timing.hpp"
#include "input/resolved.hpp"
#include "results/run_directory.hpp"
#include "results/stored_run.hpp"
#include "results/terminal.hpp"
#include "study/modes.hpp"
#include "study/trace.hpp"
#include "study/run.hpp"
#include "study/describe.hpp"
#include "study/end_check.hpp"
#include "study/strain_watch.hpp"
#include "study/teller.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {

namespace {

std::string log_line(const PathPoint& p) {
  std::string line = fmt::format("step {} {} load factor {:.17g} energy {} residual {} iterations {} negative {} zero {}: {}",
                                 p.step, p.label, p.state.load_factor, number_text("{:.17g}", p.energy.total()), number_text("{:.3g}", p.report.residual),
                                 p.report.iterations, p.stability.negative, p.stability.zero, p.report.why);
  for (const std::string& name : p.stability.zero_modes) line += "; zero mode: " + name;
  return line;
}

// What the results carry, as the text that it is in the archive of a run.
void carry_results(Archive& archive, RunDirectory& results) {
  Archive own;
  own(results);
  std::string bytes = own.bytes();
  archive(bytes);
}

std::vector<Field> null_vectors(const PathPoint& p, const Kinematics& kinematics) {
  std::vector<Field> vectors;
  for (Eigen::Index k = 0; k < p.modes.cols(); ++k) vectors.push_back(kinematics.extend(p.modes.col(k), p.state));
  return vectors;
}

}  // namespace

SingleResult run_single(const Problem& problem, const Model& model, const SingleOptions& options) {
  const Stopwatch total;
  std::optional<StateSupplement> stored;                       // it may be in the directory that is emptied now
  if (!problem.path.start.empty()) stored = read_supplement(problem.path.start);
  std::optional<Checkpoint> stopped = options.resumes ? read_checkpoint(options.directory) : std::nullopt;
  if (stopped && stopped->phase == Phase::begun) stopped.reset();
  Archive archive(stopped ? std::move(stopped->state) : std::string());
  std::string of_results;                                      // their part of the archive, the first
  if (stopped) archive(of_results);
  const auto open = [&]() -> RunDirectory {
    Archive own(of_results);
    if (stopped) return {options.directory, problem, model, own, stopped->phase == Phase::dropping || stopped->phase == Phase::ending};
    return {options.directory, problem, model, resolved_toml(problem), options.force};
  };
  RunDirectory results = open();
  const int resumed = stopped ? stopped->resumed + 1 : 0;
  if (options.record && !stopped) write_checkpoint(options.directory, {*options.record});
  results.begin(problem.title);
  Checkpointing checkpoints(results, options.record, options.checkpoint, resumed);
  if (stopped && stopped->phase == Phase::dropping) {
    results.settle();                                          // told at once: frames that are added now must not be taken for what was left
    Archive now;
    carry_results(now, results);
    checkpoints.replace(now.bytes() + std::string(archive.rest()));
  }
  Teller teller(problem, results, options.style);
  teller.log(fmt::format("elamin {}: {}{}", version(), problem.file, stopped ? ", resumed" : ""));
  Energy* energy = nullptr;                                    // of the stage
  std::optional<LowestEigenvalues> lowest;                     // of a path that has them, in the stage
  double setup = 0, checking = 0, before = 0;                 // seconds; of the sessions before this one

  factor_counts() = {};
  Summary summary;
  PathOfLandscape path_of_landscape(problem);
  std::optional<std::pair<Model, PathPoint>> ending;           // what is checked when the path has gone, whose factors may take half of the memory
  StartOfCurve start_of_curve(problem);
  StrainWatch strains;
  std::vector<Mode> found;
  std::string of_lowest;                                       // what they carried when the run was stopped
  Outcome outcome;
  const auto carry = [&](Archive& a) {
    double seconds = before + total.seconds();
    Archive own;
    if (!a.reads() && lowest) own(*lowest);
    std::string eigenvalues = own.bytes();
    if (!a.reads()) carry_results(a, results);                 // which have been read as they were made
    a(path_of_landscape, start_of_curve, strains, teller, summary.zero_modes, setup, seconds, eigenvalues, outcome.status, outcome.why, summary.check, factor_counts());
    if (a.reads()) before = seconds, of_lowest = std::move(eigenvalues);
  };
  if (stopped) carry(archive);
  const auto add = [&](PathPoint point, bool last, const std::vector<double>& eigenvalues) {
    if (last && point.label.empty()) point.label = "final";
    if (!point.report.converged()) point.stability.stable = false;          // only an equilibrium is
    for (std::size_t k = 0; k < point.report.history.size(); ++k) {
      const Iteration& i = point.report.history[k];
      teller.log(fmt::format("  iteration {} energy {} residual {} step {} shift {}", k, number_text("{:.10g}", i.energy),
                             number_text("{:.3g}", i.residual), number_text("{:.3g}", i.step), number_text("{:.3g}", i.shift)));
    }
    teller.log(log_line(point));
    const Doing writing("writing");
    const std::vector<Touch> touches = observed_touches(*energy, point.state, results.record().observables());
    const bool frame = results.is_frame(point);
    results.add(point, energy->forces(point.state), touches, eigenvalues);
    const std::vector<Field> modes = null_vectors(point, energy->kinematics());
    if (!modes.empty()) results.add_null_vectors(point.label, modes);
    if (last && point.label != "final") results.add_state("final", point, touches);
    if (!point.label.empty() || frame) {
      const Model& in_force = energy->model();
      const Fields fields = fields_at(*energy, point.state, touches);
      if (frame) results.add_frame(point, in_force, fields, touches);
      if (!point.label.empty())
        for (const std::string& label : std::set<std::string>{point.label, last ? "final" : point.label})
          results.add_fields(label, in_force, point.state, fields);
      if (results.has_film()) results.add_to_film({point.step, point.label, point.state.load_factor, in_force, point.state, fields, touches, modes});
    }
    strains.look(energy->model(), point.state, fmt::format("load factor {:.7g}", point.state.load_factor));
    summary.zero_modes = point.stability.zero_modes;
    if (last && point.report.status != Status::interrupted && std::isfinite(point.energy.total())) ending.emplace(energy->model(), point);
    teller.found(point, touches);
  };
  const Sink sink{
      .stage = [&](const Stage& stage, Energy& in_force) {
        energy = &in_force;
        results.enter(stage, energy->model());
        teller.enter(stage);
        if (problem.follows_path() && problem.path.eigenvalues > 0) lowest.emplace(energy->model(), problem.path.eigenvalues);
        if (Archive own(std::exchange(of_lowest, {})); lowest && !own.bytes().empty()) own(*lowest);
        teller.log(fmt::format("{}{} particles, {} bonds, {} angles, {} free dofs, {} entries in the Hessian's lower triangle",
                               stage.name.empty() ? "" : "stage " + stage.name + ": ", model.particles(), energy->model().bonds.size(),
                               energy->model().angles.size(), energy->dofs(), energy->hessian().nonZeros()));
        if (setup > 0) return;
        for (const std::string& note : problem.notes) teller.log("note: " + note);
        for (const std::string& warning : warnings(problem, model, *energy, model.restart.value_or(model.start))) teller.warn(warning);
        setup = total.seconds();
      },
      .point = [&](const PathPoint& point, bool last) {
        start_of_curve.take(point);
        if (problem.landscape) path_of_landscape.take(point);
        add(point, last, lowest ? lowest->at(point.state) : std::vector<double>{});
      },
      .modes = [&](const PathPoint& point, const std::vector<Mode>& modes) {
        std::vector<double> eigenvalues;
        for (const Mode& m : modes) eigenvalues.push_back(m.eigenvalue);
        add(point, true, eigenvalues);
        for (const Mode& m : modes) results.add_mode(m, point.state);
        found = modes;
      },
      .note = [&](const std::string& note) { teller.log(note); },
      .moment = [&](const Moment& moment, bool frame) {
        const Motion& m = moment.motion;
        const std::vector<Touch> touches = observed_touches(*energy, m.state, results.record().observables());
        results.add(moment, touches);
        strains.look(energy->model(), m.state, fmt::format("time {:.7g}", m.time));
        const bool in_film = frame && results.has_film();
        const Fields fields = !moment.label.empty() || in_film ? fields_at(*energy, m.state, touches) : Fields{};
        if (!moment.label.empty()) results.add_fields(moment.label, energy->model(), m.state, fields);
        if (frame) results.add_frame(m);
        if (in_film) results.add_to_film({m.step, moment.label, m.time, energy->model(), m.state, fields, touches, {}, &m});
      },
      .progress = [&](const std::string& line, double step) { teller.moved(line, step); },
      .checkpoint = [&](const std::function<void(Archive&)>& of_study) { checkpoints.offer([&](Archive& a) { carry(a), of_study(a); }); },
      .reached = [&](const PathPoint& point) { teller.reached(point); },
      .enough = [&](const PathPoint& point) { return start_of_curve.is_end(point); }};
  const auto follow_curve = [&]() -> Outcome {
    const PathPoint* const event = start_of_curve.event();
    if (!event)
      return {Status::not_converged, "the path has no " + problem.curve->of + " that a curve could begin with: " + outcome.why};
    return trace_curve(problem, options.models, *event, [&](const Row& row, const Threshold& threshold) {
      const PathPoint& point = threshold.at.point;
      const double second = threshold.second, load = point.state.load_factor;
      results.add_curve(row);
      const std::string line = fmt::format("{} = {:.12g}: {} at load factor {:.12g}{}{}", problem.curve->second, second, problem.curve->of, load,
                                           point.label.empty() ? "" : ": " + point.label, point.what.empty() ? "" : ": " + point.what);
      const auto part = (second - problem.curve->from) / (problem.curve->to - problem.curve->from);       // shown as that of the path
      teller.log(line), teller.moved(line, problem.path.from + part * (problem.path.to - problem.path.from));
    });
  };
  try {
    if (!stopped || stopped->phase != Phase::ending) outcome = trace(problem, model, stored, sink, stopped ? &archive : nullptr);
    if (ending && outcome.status != Status::interrupted) {
      const Doing doing("checking");
      const Timed timed(checking);
      summary.check = check_end(ending->first, ending->second, problem.solver.tolerance);
      ending.reset();
    }
    if (problem.curve && outcome.status == Status::converged) outcome = follow_curve();
    if (problem.landscape && outcome.status == Status::converged) {
      teller.begin("the landscape");
      outcome = trace_landscape(problem, model, path_of_landscape, results,
                                [&](const std::string& line) { teller.log(line), teller.moved(line, problem.path.to); },
                                [&](const std::string& warning) { teller.warn(warning); });
    }
    // Whatever was looked for meanwhile need not have been found, the check at the end included.
    if (outcome.status != Status::interrupted && interrupted()) outcome = {Status::interrupted, "interrupted"}, summary.check.reset();
    if (outcome.status == Status::interrupted) checkpoints.stop();
    else if (results.has_film()) checkpoints.end(carry);
    teller.finish();
    for (const std::string& warning : strains.warnings()) teller.warn(warning);
    if (summary.check && !summary.check->passed) {
      teller.warn("the last point is not what it is told to be: " + summary.check->what);
      if (outcome.status == Status::converged) outcome = {Status::not_converged, "the last point did not pass the check at the end: " + summary.check->what};
    }
    teller.log(fmt::format("{}: {}", status_name(outcome.status), outcome.why));

    summary.warnings = teller.warnings();
    summary.title = problem.title, summary.status = status_name(outcome.status), summary.message = outcome.why;
    summary.input = problem.file, summary.input_sha256 = problem.sha256;
    summary.imperfection = model.imperfection;
    summary.factorizations = factor_counts();
    summary.times = {{"setup", setup}, {"check", checking}, {"total", before + total.seconds()}};
    summary.resumed = resumed;
    summary.tolerances = {{"residual", problem.solver.tolerance}};
    if (total.seconds() > options.checkpoint) flush_to_disk(options.directory);      // what took less is soon run again
    if (!results.finish(summary)) {
      outcome = {Status::interrupted, "interrupted while films were brought to their end, which elamin resume does"};
      teller.log(fmt::format("{}: {}", status_name(outcome.status), outcome.why));
      summary.status = status_name(outcome.status), summary.message = outcome.why;
      checkpoints.stop();
      results.finish(summary);
    }
    if (outcome.status != Status::interrupted) checkpoints.remove();
  } catch (const std::exception& error) {
    results.break_off(problem.title, told(error) + "; what was found until then is kept, and elamin resume goes on from there");
    teller.finish(), checkpoints.try_to_stop();
    throw;
  }

  const Record& record = results.record();
  SingleResult result{outcome.status, outcome.why, record.path(), record.events(), results.curve(), results.landscape(), record.columns(),
                      std::move(found), summary.zero_modes, summary.warnings, {}};
  result.verdicts = check_expectations(problem, result.path, result.events, result.curve, result.landscape);
  return result;
}

SingleResult stored_result(const Problem& problem, const std::string& directory) {
  StoredRun run = read_run(directory);
  const bool done = run.summary->status == status_name(Status::converged);
  SingleResult result{done ? Status::converged : Status::not_converged, run.summary->message, std::move(run.path), std::move(run.events),
                      std::move(run.curve), std::move(run.landscape), {}, {}, run.summary->zero_modes, run.summary->warnings, {}};
  result.verdicts = check_expectations(problem, result.path, result.events, result.curve, result.landscape);
  return result;
}

int exit_status(const SingleResult& result) {
  if (result.status == Status::interrupted) return exit_interrupted;
  return result.status == Status::converged ? exit_done : exit_not_converged;
}

}  // namespace elamin
