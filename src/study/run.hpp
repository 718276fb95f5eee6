#pragma once
// One study from its problem to its directory, and many of them side by side.
#include "input/problem.hpp"
#include "input/settings.hpp"
#include "results/expectations.hpp"
#include "study/checkpoint.hpp"

#include <string>
#include <vector>

namespace elamin {

/// Exit statuses of the program.
enum ExitStatus { exit_done = 0, exit_wrong_input = 1, exit_not_converged = 2, exit_not_met = 3, exit_interrupted = 130 };

/// Of a sweep the runs K, K + N, K + 2N, …
struct SweepPart { int number = 1, of = 1; };

struct RunOptions {
  std::string file;                    // the problem file
  std::vector<Setting> settings;       // --set KEY=VALUE
  std::string directory;               // "": the problem file's name without .toml
  int threads = 0;                     // 0: usual_threads()
  bool force = false;                  // write to a directory that is not results of elamin, too
  bool quiet = false;
  bool report = false;                 // a page is made of it: a path that says nothing of frames keeps 50, without films
  double checkpoint = 1;               // seconds between two checkpoints; 0: one wherever it could go on from
  bool resumes = false;                // it was stopped and goes on, if there is anything to go on from; else it begins
  bool by_ranks = false;               // all ranks come here, and share the runs of a sweep
  std::optional<SweepPart> part = {};  // that part of a sweep alone
  std::optional<RunRecord> record = {};     // of what is asked for; none, as of a problem that a program has put together: the run cannot be resumed
};

/// What a run came to.
struct [[nodiscard]] RunResult {
  int exit_status = exit_done;
  std::string directory;
  std::vector<Verdict> verdicts;       // of its [[expect]]
};

struct PreparedRuns;

/// Threads of a run that asks for no number: OMP_NUM_THREADS; where that is not set, the cores that this process may use, shared equally by the ranks on
/// the machine.
int usual_threads();

/// Reads, checks, runs and writes a problem file; with [[sweep]] one run for each combination, in parallel.
/// Throws InputError before anything is written if the file is wrong.
RunResult run(const RunOptions& options);

/// The same of what has been read and built; options.settings: those it was read with.
RunResult run(PreparedRuns& prepared, const RunOptions& options);

}  // namespace elamin
