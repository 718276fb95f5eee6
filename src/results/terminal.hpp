#pragma once
// What a run shows while it works.
#include "core/timing.hpp"
#include "path/point.hpp"
#include "results/mode.hpp"
#include "results/table.hpp"
#include "solve/ranks.hpp"

#include <fmt/color.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace elamin {

// Words that a terminal shows in colour.

/// Whether lines can be overwritten there: a terminal that is not dumb, and not one that mpirun puts between a program and its file.
inline bool is_terminal(std::FILE* out) {
  const char* kind = std::getenv("TERM");
  return !ranks() && isatty(fileno(out)) && kind && *kind && std::string(kind) != "dumb";
}

/// Characters of a line that does not reach the last column; 79 where there is no terminal.
inline int terminal_width(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
}

/// Marks words on a terminal, unless the environment has NO_COLOR with something in it (no-color.org); elsewhere they stay as they are.
class Ink {
 public:
  Ink() = default;
  explicit Ink(std::FILE* out) {
    const char* none = std::getenv("NO_COLOR");
    on_ = is_terminal(out) && !(none && *none);
  }
  std::string good(const std::string& words) const { return marked(fg(fmt::terminal_color::green), words); }
  std::string bad(const std::string& words) const { return marked(fg(fmt::terminal_color::red), words); }
  std::string warning(const std::string& words) const { return marked(fg(fmt::terminal_color::yellow), words); }
  std::string strong(const std::string& words) const { return marked(fmt::emphasis::bold, words); }

 private:
  std::string marked(const fmt::text_style& style, const std::string& words) const { return on_ ? fmt::format(style, "{}", words) : words; }
  bool on_ = false;
};

/// The number by a format of fmt; "not finite" where it is none.
std::string number_text(const char* format, double v);

/// One line of a point: step, load factor, energy, residual, stability, label, iterations, closed contacts where there are any.
std::string progress_line(const PathPoint& point, int contacts = 0);

/// terminal: one line that is overwritten, with a bar where there is a way to go; events stay. plain: lines, at most one for every
/// tenth of the path or every second, and one for every event. silent: nothing.
class Progress {
 public:
  enum class Style { silent, plain, terminal };
  static Style style_for(std::FILE* out, bool quiet);

  /// from, to: load factors of the path (or the first and the last step of a motion), for its tenths. steady: it goes from one to the other
  /// without turning, so that the time that is left can be told.
  Progress(std::FILE* out, Style style, double from, double to, bool steady = true);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What comes now is one of several parts, from 0, between these load factors.
  void enter(int part, int parts, double from, double to);

  void show(const PathPoint& point, int contacts = 0);
  /// Any other line, at a value between from and to.
  void show(const std::string& line, double at);
  /// That the next point takes its time; pieces: the same for the overwritten line, the last ones may be left out.
  void wait(const std::string& line, const std::vector<std::string>& pieces = {});
  /// A line that stays, above the overwritten one.
  void keep(const std::string& line);
  /// Takes the overwritten line away; nothing else is shown after that.
  void finish();

 private:
  /// A part of the overwritten line; the last ones that do not fit are left out.
  struct Piece {
    std::string words;
    std::string (Ink::*ink)(const std::string&) const = nullptr;
  };
  double done(double at) const;                                      // part of the way, from 0 to 1
  bool due(double at);                                               // a plain line
  void draw(double at, std::vector<Piece> pieces);

  std::FILE* out_;
  Style style_;
  Ink ink_;
  double from_, to_;                    // load factors
  int part_ = 0, parts_ = 1;
  bool steady_;
  double last_ = 0;                     // at the last line
  bool first_ = true, pending_ = false;
  double last_time_ = 0;
  Stopwatch clock_;
};

// What a run says at its end, in tables for reading.

/// The events of a path, or a sentence that there were none; of many the first ones.
std::string closing_table(const Table& events, const Ink& ink = {});

/// The points of a curve that have a label; second: the key of its parameter.
std::string closing_curve(const Table& curve, const std::string& second);

/// The nodes of landscapes, and what becomes of them.
std::string closing_landscape(const Table& landscape, const Ink& ink = {});

/// The last row of a study: energy, residual and stability, or time and kinetic energy of a motion, and a line for each observable.
std::string closing_values(const Table& path, const std::vector<std::string>& observables, const Ink& ink = {});

/// Number and eigenvalue of each mode, and the name of those that are zero.
std::string closing_modes(const std::vector<Mode>& modes, const Ink& ink = {});

}  // namespace elamin
