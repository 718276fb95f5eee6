#include "study/run.hpp"

#include "core/parallel.hpp"
#include "core/say.hpp"
#include "results/terminal.hpp"
#include "results/summary.hpp"
#include "solve/blas.hpp"
#include "solve/ranks.hpp"
#include "study/single.hpp"
#include "study/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace elamin {

namespace {

const int threads_at_start = omp_get_max_threads();            // before set_threads

std::string default_directory(const std::string& file) {
  std::filesystem::path path(file);
  if (path.extension() == ".toml") return path.replace_extension().string();
  return file + ".results";
}

// What was found, what is doubtful of it, and how it ended.
std::string closing(const Problem& problem, const SingleResult& result, const Ink& ink) {
  const StudyType study = problem.study;
  std::string text = problem.follows_path()      ? closing_table(result.events, ink)
                     : study == StudyType::modes ? closing_modes(result.modes, ink)
                                                 : closing_values(result.path, result.observables, ink);
  if (problem.curve) text += closing_curve(result.curve, problem.curve->second);
  if (study == StudyType::landscape) text += closing_landscape(result.landscape, ink);
  for (const std::string& name : result.zero_modes) text += fmt::format("free at the end: {}\n", name);
  for (const std::string& warning : result.warnings) text += ink.warning("warning") + ": " + warning + "\n";
  const std::string status = status_name(result.status);
  return text + fmt::format("{}: {}\n", result.status == Status::converged ? ink.good(status) : ink.bad(status), result.why);
}

RunResult run_one(const PreparedRun& run, const RunOptions& options) {
  const ShareFactorizations shared;
  if (Ranks* const all = ranks(); all && !run.problem.solver.petsc.empty()) all->set_options(run.problem.solver.petsc);
  const SingleResult result = run_single(run.problem, run.model, {options.directory, options.force, Progress::style_for(stdout, options.quiet), options.record,
                                                                  options.checkpoint, options.resumes, run.models});
  if (!options.quiet) say("{}written: {}\n", closing(run.problem, result, Ink(stdout)), options.directory);
  else if (result.status != Status::converged) complain("{}: {}\n", status_name(result.status), result.why);
  return {exit_status(result), options.directory, result.verdicts};
}

// A page's shape follows the path where states of it are kept.
void keep_frames(Problem& problem) {
  if (problem.follows_path() && !problem.path.has_frames()) problem.path.frames = 50, problem.path.film.emplace();
}

}  // namespace

int usual_threads() {
  const int sharing = ranks() && !std::getenv("OMP_NUM_THREADS") ? ranks()->on_this_machine() : 1;
  return std::max(1, threads_at_start / sharing);
}

RunResult run(const RunOptions& options) {
  PreparedRuns prepared = prepare_runs(options.file, options.settings);
  RunOptions recorded = options;
  recorded.record = record_of(prepared.document, options.settings, options.report, input_hashes(prepared));
  return run(prepared, recorded);
}

RunResult run(PreparedRuns& prepared, const RunOptions& given) {
  RunOptions options = given;
  if (options.threads <= 0) options.threads = usual_threads();
  set_threads(options.threads), ready_blas();
  if (options.directory.empty()) options.directory = default_directory(options.file);
  if (options.report)
    for (PreparedRun& run : prepared.runs) keep_frames(run.problem);
  if (options.part) return run_sweep_part(prepared, options);
  if (options.by_ranks && ranks() && is_sweep(prepared)) return run_sweep_by_ranks(prepared, options);
  if (prepared.bisection) return run_bisection(prepared, options);
  return is_sweep(prepared) ? run_sweep(prepared, options) : run_one(prepared.runs.front(), options);
}

}  // namespace elamin
