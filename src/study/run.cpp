#include "study/run.hpp"

#include "core/parallel.hpp"
#include "results/summary.hpp"
#include "study/single.hpp"
#include "study/sweep.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <thread>

namespace elamin {

namespace {

std::string default_directory(const std::string& file) {
  std::filesystem::path path(file);
  if (path.extension() == ".toml") return path.replace_extension().string();
  return file + ".results";
}

int cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

RunResult run_one(const PreparedRun& run, const RunOptions& options) {
  const SingleResult result = run_single(run.problem, run.model, options.directory, options.force, Progress::style_for(stdout, options.quiet));
  if (!options.quiet) {
    if (!run.problem.in_time()) fmt::print("{}", closing_table(result.events));
    for (const std::string& name : result.zero_modes) fmt::print("free at the end: {}\n", name);
    fmt::print("{}: {}\nwritten: {}\n", status_name(result.status), result.why, options.directory);
  } else if (result.status != Status::converged) {
    fmt::print(stderr, "{}: {}\n", status_name(result.status), result.why);
  }
  return {exit_status(result), options.directory, result.verdicts};
}

}  // namespace

RunResult run(const RunOptions& given) {
  RunOptions options = given;
  if (options.threads <= 0) options.threads = cores();
  set_threads(options.threads);
  if (options.directory.empty()) options.directory = default_directory(options.file);
  const PreparedRuns prepared = prepare_runs(options.file, options.settings);
  if (prepared.bisection) return run_bisection(prepared, options);
  const bool single = prepared.runs.size() == 1 && prepared.runs.front().swept.empty();
  return single ? run_one(prepared.runs.front(), options) : run_sweep(prepared, options);
}

}  // namespace elamin
