#pragma once
// A sweep in parts, for machines that share a file system: elamin FILE --part K/N, then elamin collect DIR.
#include "study/run.hpp"

#include <string>

namespace elamin {

struct PreparedRuns;

/// "K/N" as part K of N. Throws InputError where it is not that, or K is not within 1 … N.
SweepPart parse_part(const std::string& text);

/// The runs K, K + N, K + 2N, … of a sweep into its directory, which parts share: what has ended there is not run again, what was
/// stopped goes on. No sweep.csv is written. Throws InputError where the directory holds anything but parts of the same sweep.
RunResult run_sweep_part(const PreparedRuns& prepared, const RunOptions& options);

struct CollectOptions {
  std::string directory;
  bool quiet = false;
};

/// Writes sweep.csv of what has ended of a sweep that was run in parts. Not converged if runs are missing, which are named.
/// Throws InputError if the directory is not of such a sweep, or a run is at work in it.
RunResult collect(const CollectOptions& options);

}  // namespace elamin
