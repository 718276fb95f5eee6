#include "study/single.hpp"

#include "core/timing.hpp"
#include "problem/resolved.hpp"
#include "results/lammps_state.hpp"
#include "results/run_directory.hpp"
#include "study/run.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

namespace elamin {

namespace {

std::string log_line(const PathPoint& p) {
  std::string line = fmt::format("step {} {} load factor {:.17g} energy {:.17g} residual {:.3g} iterations {} negative {} zero {}: {}",
                                 p.step, p.label, p.state.load_factor, p.energy.total(), p.report.residual,
                                 p.report.iterations, p.stability.negative, p.stability.zero, p.report.why);
  for (const std::string& name : p.stability.zero_modes) line += "; zero mode: " + name;
  return line;
}

}  // namespace

SingleResult run_single(const Problem& problem, const Model& model, const std::string& directory, Progress::Style style) {
  const Stopwatch total;
  RunDirectory results(directory, problem, model, resolved_toml(problem));
  results.log(fmt::format("elamin {}: {}", version(), problem.file));
  Energy energy(model);
  results.log(fmt::format("{} particles, {} bonds, {} angles, {} free dofs, {} entries in the Hessian's lower triangle",
                          model.particles(), model.bonds.size(), model.angles.size(), energy.dofs(), energy.pattern().nonZeros()));
  const double setup = total.seconds();

  Progress progress(stdout, style, starting_load_factor(problem), problem.path.to);
  const Sink sink{
      .point = [&](const PathPoint& found, bool last) {
        PathPoint point = found;
        if (last && point.label.empty()) point.label = "final";
        for (std::size_t k = 0; k < point.report.history.size(); ++k) {
          const Iteration& i = point.report.history[k];
          results.log(fmt::format("  iteration {} energy {:.10g} residual {:.3g} step {:.3g} shift {:.3g}", k, i.energy, i.residual, i.step, i.shift));
        }
        results.log(log_line(point));
        results.add(point, energy.forces(point.state));
        if (last && point.label != "final") write_state(results.state_file("final"), model, point.state, problem.title);
        progress.show(point);
      },
      .note = [&](const std::string& note) { results.log(note); }};
  const Outcome outcome = trace(problem, energy, sink);
  progress.finish();
  results.log(fmt::format("{}: {}", status_name(outcome.status), outcome.why));

  Summary summary;
  summary.title = problem.title, summary.status = status_name(outcome.status), summary.message = outcome.why;
  summary.input = problem.file, summary.input_sha256 = problem.sha256;
  summary.times = {{"setup", setup}, {"total", total.seconds()}};
  summary.tolerances = {{"residual", problem.solver.tolerance}};
  results.finish(summary);

  SingleResult result{outcome.status, outcome.why, results.record().path(), results.record().events(), results.record().observables(), {}};
  result.verdicts = check_expectations(problem, result.path, result.events);
  return result;
}

int exit_status(const SingleResult& result) {
  if (result.status == Status::interrupted) return exit_interrupted;
  return result.status == Status::converged ? exit_done : exit_not_converged;
}

}  // namespace elamin
