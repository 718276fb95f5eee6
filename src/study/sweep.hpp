#pragma once
// All runs of a file with [[sweep]].
#include "study/prepare.hpp"
#include "study/run.hpp"
#include "study/single.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// Whether there are runs over given values, be it one.
inline bool is_sweep(const PreparedRuns& prepared) { return !prepared.bisection && !prepared.runs.front().swept.empty(); }

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

/// The runs of these numbers side by side, each on one thread: what each came to, nothing of others and of those that a signal kept from
/// beginning. `ended` hears of each as it ends, from its thread. What one of them throws is thrown when all have ended.
std::vector<std::optional<SingleResult>> run_side_by_side(const std::vector<PreparedRun>& runs, const std::vector<std::size_t>& which,
                                                          const RunOptions& options,
                                                          const std::function<void(std::size_t, const SingleResult&)>& ended = {});

/// How many there are.
std::size_t ended(const std::vector<std::optional<SingleResult>>& results);

/// The row of a run in sweep.csv. first: the problem of the first run.
Row sweep_row_of(const PreparedRun& run, const SingleResult& result, const Problem& first);

/// The worst status and all verdicts; of expectations about all runs together only where all runs are there.
RunResult result_of_runs(const PreparedRuns& prepared, const std::vector<std::optional<SingleResult>>& results, const std::string& directory);

/// The name of a run's directory: its number, as wide as that of the last, and what is swept (but for expected values),
/// the last word of each key.
std::string run_name(std::size_t number, std::size_t runs, const std::vector<Setting>& swept);

/// The swept keys, and their values as they stand in sweep.csv: numbers where they are such.
std::vector<std::string> swept_keys(const PreparedRun& run);
std::vector<Cell> swept_values(const PreparedRun& run);

}  // namespace elamin
