#pragma once
// All runs of a file with [[sweep]].
#include "results/results_directory.hpp"
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

/// Numbers of runs, one at a call, until there is none; asked by one thread at a time.
using RunNumbers = std::function<std::optional<std::size_t>()>;

/// So many of these runs, as they are numbered, side by side, each on one thread: what each came to, nothing of others and of those that a signal
/// kept from beginning. `ended` hears of each as it ends, from its thread. What one of them throws is thrown when all have ended.
std::vector<std::optional<SingleResult>> run_side_by_side(const std::vector<PreparedRun>& runs, const RunNumbers& next, std::size_t count, const RunOptions& options,
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

// A sweep in parts, for machines that share a file system: elamin FILE --part K/N, then elamin collect DIR.

struct PreparedRuns;

/// "K/N" as part K of N. Throws InputError where it is not that, or K is not within 1 … N.
SweepPart parse_part(const std::string& text);

/// The runs K, K + N, K + 2N, … of a sweep into its directory, which parts share: what has ended there is not run again, what was
/// stopped goes on. No sweep.csv is written. Throws InputError where the directory holds anything but parts of the same sweep.
RunResult run_sweep_part(const PreparedRuns& prepared, const RunOptions& options);

/// The same of runs that are dealt out to all ranks, each as it gets one done; rank 0 then collects them. Called by all ranks.
RunResult run_sweep_by_ranks(const PreparedRuns& prepared, const RunOptions& options);

struct CollectOptions {
  std::string directory;
  bool quiet = false;
};

/// Writes sweep.csv of what has ended of a sweep that was run in parts. Not converged if runs are missing, which are named.
/// Throws InputError if the directory is not of such a sweep, or a run is at work in it.
RunResult collect(const CollectOptions& options);

}  // namespace elamin
