#pragma once
#include "path/contact_event.hpp"
#include "path/locate.hpp"
#include "path/options.hpp"

#include <deque>
#include <string>
#include <utility>

namespace elamin {

/// A path in steps of the load factor: an iterator that yields equilibria and, between them, located events.
///   LoadSteps path(newton, start, options);
///   while (const auto point = path.next()) …;
///   path.status(), path.why()
/// Steps that fail are halved, down to 2⁻²⁰ of a step; halved steps double again, so that every multiple of the step
/// is hit. The Morse index is known at every equilibrium; where it changes the event is located before going on.
class LoadSteps {
 public:
  LoadSteps(Newton& newton, const State& start, PathOptions options);

  /// The next equilibrium; nothing at the end.
  std::optional<PathPoint> next();
  Status status() const { return status_; }
  const std::string& why() const { return why_; }
  /// What happened besides, one sentence each (jumps), for the log; emptied by the call.
  std::vector<std::string> notes() { return std::exchange(notes_, {}); }

 private:
  bool begin();
  bool step();
  bool meet(ContactEvent event);
  bool lose_stability(const Event& event, double target);
  bool fall(double target);
  bool jump(const Event& event, double target);
  void emit(PathPoint point);
  void emit(Event& event);
  bool end(Status status, std::string why);

  Newton& newton_;
  PathOptions options_;
  State start_;
  std::vector<double> targets_;
  std::size_t interval_ = 0;             // towards targets_[interval_]
  double interval_start_ = 0;            // load factor at which the halving of this interval counts from
  std::int64_t done_ = 0;                // of 2^finest parts of the interval
  int halvings_ = 0;
  Equilibrium current_;
  ContactSet closed_;                    // contacts from current_ on
  bool begun_ = false, ended_ = false;
  int steps_ = 0, branch_ = 0, branch_points_ = 0, limit_points_ = 0, contact_events_ = 0;
  std::deque<PathPoint> ready_;
  Status status_ = Status::converged;
  std::string why_;
  std::vector<std::string> notes_;
};

}  // namespace elamin
