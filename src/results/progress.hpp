#pragma once
// What a run shows while it works, and the table at its end.
#include "core/timing.hpp"
#include "path/point.hpp"
#include "results/table.hpp"

#include <cstdio>
#include <string>

namespace elamin {

/// One line of a point: step, load factor, energy, residual, stability.
std::string progress_line(const PathPoint& point);

/// terminal: one line that is overwritten, events stay. plain: lines, at most one for every tenth of the path or every
/// second, and one for every event. silent: nothing.
class Progress {
 public:
  enum class Style { silent, plain, terminal };
  static Style style_for(std::FILE* out, bool quiet);

  /// from, to: load factors of the path (or the first and the last step of a motion), for its tenths.
  Progress(std::FILE* out, Style style, double from, double to);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const PathPoint& point);
  /// Any other line, at a value between from and to; `lasting`: it stays.
  void show(const std::string& line, double at, bool lasting);
  /// Takes the overwritten line away; nothing else is shown after that.
  void finish();

 private:
  std::FILE* out_;
  Style style_;
  double span_, last_ = 0;              // load factors
  bool first_ = true, pending_ = false;
  double last_time_ = 0;
  Stopwatch clock_;
};

/// The events of a run as a short table for reading, or a sentence that there were none.
std::string closing_table(const Table& events);

}  // namespace elamin
