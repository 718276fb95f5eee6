#pragma once
// All runs of a file with [[sweep]].
#include "study/prepare.hpp"
#include "study/run.hpp"

namespace elamin {

/// Seconds between two lines of a sweep that only say that it is at work.
inline constexpr double heartbeat = 4;

/// Runs side by side, each on one thread; sweep.csv has a row for each. `options` are complete (threads, directory).
RunResult run_sweep(const PreparedRuns& prepared, const RunOptions& options);

/// Runs at both ends, then where the outcome changes between them, halving; sweep.csv has a row for each run in the order
/// of the key, summary.json the threshold. Not converged if both ends have the same outcome.
RunResult run_bisection(const PreparedRuns& prepared, const RunOptions& options);

/// The name of a run's directory: its number, as wide as that of the last, and what is swept (but for expected values),
/// the last word of each key.
std::string run_name(std::size_t number, std::size_t runs, const std::vector<Setting>& swept);

/// The swept keys, and their values as they stand in sweep.csv: numbers where they are such.
std::vector<std::string> swept_keys(const PreparedRun& run);
std::vector<Cell> swept_values(const PreparedRun& run);

}  // namespace elamin
