#pragma once
// What a run that is stopped, in whatever way, goes on from: DIR/.elamin.checkpoint.
#include "core/archive.hpp"
#include "core/timing.hpp"
#include "input/problem.hpp"
#include "input/settings.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace elamin {

class RunDirectory;
struct PreparedRuns;

/// What was asked for.
struct RunRecord {
  static constexpr int all = -1, not_alone = -2;
  std::string file, folder, text;                               // the problem file as it was named; its folder, seen from DIR; what it said
  std::vector<std::pair<std::string, std::string>> settings;    // --set
  bool report = false;                                          // RunOptions::report
  int run = all;                                                // of a sweep that one; not_alone: of a bisection some one
  std::vector<std::pair<std::string, std::string>> inputs;      // the files that it reads besides, and the SHA-256 of each
};

/// Nothing where the document is not what its file holds. `inputs` as input_hashes has them.
std::optional<RunRecord> record_of(const Document& document, const std::vector<Setting>& settings, bool report,
                                   const std::vector<std::pair<std::string, std::string>>& inputs);
std::vector<std::pair<std::string, std::string>> input_hashes(const PreparedRuns& prepared);

/// begun: before the first state that it could go on from. dropping, ending: while frames were dropped, or everything was brought to its end.
enum class Phase : char { begun, going, dropping, ending };

struct Checkpoint {
  RunRecord record = {};
  Phase phase = Phase::begun;
  int resumed = 0;                                              // how often it has been stopped before
  std::string state = {};                                            // of an Archive
};

/// SHA-256 of all sources, compiler and flags, 64 hexadecimal digits: of equal ones a checkpoint's bytes mean the same and lead to the same bits.
std::string build_fingerprint();

/// Nothing where there is none. Throws InputError if it is not whole, if its bytes have not the checksum in it, or if it is of another version or build.
std::optional<Checkpoint> read_checkpoint(const std::string& directory);
/// `record.folder` is put in: it depends on the directory.
void write_checkpoint(const std::string& directory, Checkpoint checkpoint);
void remove_checkpoint(const std::string& directory);

/// Keeps the checkpoint of one run while it is at work: in memory for an orderly stop, and on the disk at most every so many seconds, each so that all that
/// it costs, what must be brought to the disk before included, stays below a hundredth of the run's time. Every byte of the results that it speaks of is on the disk before it is.
class Checkpointing {
 public:
  /// No record: none is ever written. every 0: at each place that is offered.
  Checkpointing(RunDirectory& results, std::optional<RunRecord> record, double every, int resumed);

  /// A place that the run can go on from, with all that it carries there.
  void offer(const std::function<void(Archive&)>& carry);
  /// The place that the run goes on from, anew: the results have changed since.
  void replace(std::string state);
  /// The run stops: the last place that was kept is written.
  void stop();
  /// The same where that may not be possible either.
  void try_to_stop();
  /// The run is all but at its end, which begins here, with all that it carries: the last place to go on from.
  void end(const std::function<void(Archive&)>& carry);
  /// The results are whole.
  void remove();

 private:
  void write(Phase phase);

  RunDirectory& results_;
  Checkpoint latest_;
  bool any_, kept_ = false, written_ = false;
  double every_, keeping_ = 0, writing_ = 0;                    // seconds
  Stopwatch elapsed_, since_;
};

}  // namespace elamin
