#pragma once
#include "study/prepare.hpp"
#include "study/run.hpp"

namespace elamin {

struct ResumeOptions {
  std::string directory;               // of the results
  int threads = 0;                     // 0: all cores
  double checkpoint = 1;               // see RunOptions
  bool quiet = false;
};

/// `elamin resume DIR`: a run or a sweep that was stopped goes on where it was, with the same bits as if it had never been stopped; of one that has ended
/// it says so. Throws InputError where DIR is no results, or of another version, where a run is at work in it, or where a file that the problem reads is
/// not what it was.
RunResult resume(const ResumeOptions& options);

/// Whether all runs of a sweep have ended: its table is there and nothing is left to go on from.
bool sweep_has_ended(const std::string& directory);

/// What was asked for in a directory where not all of it is done yet, read and built again. Throws InputError as resume does.
struct StoppedRuns {
  RunRecord record;
  std::vector<Setting> settings;
  PreparedRuns prepared;
};
StoppedRuns stopped_runs(const std::string& directory);

}  // namespace elamin
