#pragma once
#include "path/path.hpp"

namespace elamin {

/// Load factors to hit, in order: the even steps and the stops asked for.
std::vector<double> load_targets(const PathOptions& options);

/// A branch in steps of the load factor. Steps that fail are halved, down to 2⁻²⁰ of a step; halved steps double again, so
/// that every multiple of the step is hit. The Morse index is known at every equilibrium; where it changes the event is
/// located before going on. Where steps fail, the branch is followed in arc length to see what is there: a limit point, a
/// branch point that is reached along a side branch, or only a sharp bend.
class LoadSteps : public Path {
 public:
  LoadSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering = nullptr);

 protected:
  void advance() override;

 private:
  void begin();
  void step();
  bool explore(double target);
  void meet(ContactChange change, double target);
  void reach(std::vector<Event> watched);
  void lose_stability(Event event, double target);
  void pass(const Event& event, double target);
  bool fall(double target);
  void jump(const Event& event, double target);
  void settle(Equilibrium at, double load_factor, const std::vector<Event>& passed = {});

  Newton& newton_;
  PathOptions options_;
  State start_;
  std::vector<double> targets_;
  std::size_t interval_ = 0;             // towards targets_[interval_]
  double interval_start_ = 0;            // load factor at which the halving of this interval counts from
  std::int64_t done_ = 0;                // of 2^finest parts of the interval
  int halvings_ = 0;
  Equilibrium current_;
  int negative_ = 0;                     // Morse index from current_ on
  ContactSet closed_;                    // contacts from current_ on
  std::vector<double> side_;             // of every watch: observable − value from current_ on
  bool begun_ = false, told_already_ = false;   // the event that the path is taken up at
};

}  // namespace elamin
