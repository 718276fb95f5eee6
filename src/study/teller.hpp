#pragma once
// What a run tells while it works.
#include "core/heartbeat.hpp"
#include "results/terminal.hpp"
#include "results/run_directory.hpp"

#include <mutex>
#include <string>
#include <vector>

namespace elamin {

/// log.txt and the lines on the terminal; where the next point takes long, in both at least every few seconds that it is at work on
/// it, and what that is doing. That comes from a thread of its own.
class Teller {
 public:
  /// Both must outlive this.
  Teller(const Problem& problem, RunDirectory& results, Progress::Style style);

  void log(const std::string& line);
  void warn(const std::string& warning);
  const std::vector<std::string>& warnings() const { return warnings_; }
  void carry(Archive& archive) { archive(warnings_); }

  /// Where the points that come are: in a stage of the path; it has come to this one, which is then told; a motion has come to this step.
  void enter(const Stage& stage);
  void reached(const PathPoint& point);
  void found(const PathPoint& point, const std::vector<Touch>& touches);
  void moved(const std::string& line, double step);
  /// What comes behind the path: "the landscape".
  void begin(const std::string& what);
  /// Takes the overwritten line away; then nothing is told but to the log.
  void finish();

 private:
  void at_work(const std::vector<std::string>& doing);

  const Problem& problem_;
  RunDirectory& results_;
  Progress::Style style_;
  Progress progress_;
  std::mutex mutex_;
  Stopwatch since_point_, since_line_;
  std::string after_;                            // what is looked for
  std::vector<std::string> warnings_;
  Heartbeat heartbeat_;                          // last: it looks at the others
};

}  // namespace elamin
