#pragma once
// What a path is to those who trace it: an iterator over equilibria and, between them, located events.
#include "core/archive.hpp"
#include "path/event.hpp"
#include "path/options.hpp"

#include <deque>
#include <map>
#include <memory>
#include <utility>

namespace elamin {

/// Numbers that run through all branches of a diagram.
struct Numbering {
  int steps = 0, branches = 0, limits = 0, branch_points = 0, contacts = 0, jumps = 0;
  std::map<std::string, int> user_events;
};

///   auto path = make_path(newton, start, options);
///   while (const auto point = path->next()) …;
///   path->status(), path->why()
class Path {
 public:
  explicit Path(Numbering* shared = nullptr) : numbering_(shared ? *shared : own_) {}
  virtual ~Path() = default;
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

  /// The next equilibrium; nothing at the end.
  std::optional<PathPoint> next();
  Status status() const { return status_; }
  const std::string& why() const { return why_; }
  /// What happened besides, one sentence each, for the log; emptied by the call.
  std::vector<std::string> notes() { return std::exchange(notes_, {}); }
  /// Branch points found so far, for who wants to switch at them.
  const std::vector<Event>& branch_points() const { return branch_points_; }

  /// What goes on from point to point. A path made of the same start and options that reads it goes on where the other one stood, with the same bits
  /// if its energy and factors carry on too.
  virtual void carry(Archive& archive);

 protected:
  /// Goes on: emits any number of points, or ends.
  virtual void advance() = 0;
  void emit(PathPoint point);
  /// Labels an event and emits it.
  void emit(Event& event);
  /// Labels where a snap has ended, on a branch of its own, and emits it; before: the Morse index where it began.
  void emit_landing(PathPoint point, std::string what, int before, std::string parent);
  void note(std::string sentence) { notes_.push_back(std::move(sentence)); }
  void end(Status status, std::string why);
  void take(PathPoint point) { ready_.push_back(std::move(point)); }
  bool ended() const { return ended_; }
  Numbering& numbering() { return numbering_; }

  int branch_ = 0;                     // that points belong to now …
  std::string parent_;                 // … and where it comes from

 private:
  Numbering own_;
  Numbering& numbering_;
  bool ended_ = false;
  std::deque<PathPoint> ready_;
  std::vector<Event> branch_points_;
  Status status_ = Status::converged;
  std::string why_;
  std::vector<std::string> notes_;
};

/// The path that the options ask for, from a state (prescribed coordinates are put where the load factor wants them):
/// the first branch by load steps or in arc length, then branches that are switched to, then what deflation finds.
std::unique_ptr<Path> make_path(Newton& newton, const State& start, const PathOptions& options);

}  // namespace elamin
