#pragma once
// All runs of a file with [[sweep]].
#include "study/prepare.hpp"
#include "study/run.hpp"
#include "study/single.hpp"

#include <memory>

namespace elamin {

/// Seconds between two lines of a sweep that only say that it is at work.
inline constexpr double heartbeat = 4;

/// Runs side by side, each on one thread; sweep.csv has a row for each. `options` are complete (threads, directory).
RunResult run_sweep(const PreparedRuns& prepared, const RunOptions& options);

/// Runs at both ends, then where the outcome changes between them, halving; sweep.csv has a row for each run in the order
/// of the key, summary.json the threshold. Not converged if both ends have the same outcome.
RunResult run_bisection(const PreparedRuns& prepared, const RunOptions& options);

/// The directory of many runs, with a checkpoint that says what was asked for; of a sweep or bisection that goes on as it is.
std::unique_ptr<ResultsDirectory> results_of_runs(const RunOptions& options, const Problem& first);

/// One of many runs: what it came to if it goes on and has ended before, else the rest of it or all. number: RunRecord::run.
SingleResult run_part(const PreparedRun& run, const std::string& directory, const RunOptions& options, int number);

/// The name of a run's directory: its number, as wide as that of the last, and what is swept (but for expected values),
/// the last word of each key.
std::string run_name(std::size_t number, std::size_t runs, const std::vector<Setting>& swept);

/// The swept keys, and their values as they stand in sweep.csv: numbers where they are such.
std::vector<std::string> swept_keys(const PreparedRun& run);
std::vector<Cell> swept_values(const PreparedRun& run);

}  // namespace elamin
