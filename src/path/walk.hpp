#pragma once
// Steps in arc length along one branch, with what happens on them located.
#include "path/arc.hpp"
#include "path/event.hpp"
#include "path/options.hpp"

#include <optional>
#include <vector>

namespace elamin {

struct WalkOptions {
  double load_step = 0.01;             // no step changes the load factor by more
  double turn = 0.05;                  // … nor turns or stretches a bond by more (rad)
  bool contacts = true;
  std::vector<double> stops;           // load factors at which it stops on the way
  std::vector<Watch> watches;
  std::string told;                    // label of the event that it begins at: a watch's own side is not known there
  double step = 0, shortest = 0;       // of the first step, in the metric; 0: as long as the limits above let it be
};

/// What a step led to: the next equilibrium, an event before it, or a stop.
struct Waypoint {
  Equilibrium at;
  std::optional<Event> event;          // then `at` is the event's
  std::optional<double> stop;          // the load factor of the stop that was met
};

/// Follows a branch, stable or not, through limit points and over branch points. Steps are as long as the corrector's
/// iterations (4 are aimed at), the turn of the branch's direction (0.25 rad) and the options allow, and are shortened
/// where the corrector leaves the tangent by more than half a step, where the direction turns too far, where an event
/// cannot be resolved.
class Walk {
 public:
  /// From an equilibrium along a direction; negative: the Morse index beyond it; closed: the contacts.
  Walk(Newton& newton, Equilibrium start, Direction direction, int negative, ContactSet closed, Metric metric, WalkOptions options);

  /// The next waypoint; nothing where the branch cannot be followed any further: why() says why.
  std::optional<Waypoint> next();
  const std::string& why() const { return why_; }
  Status status() const { return status_; }

  const Equilibrium& at() const { return current_; }
  const Direction& direction() const { return direction_; }
  /// As it is now: L falls to the least Λ |dx/dλ| that is met.
  const Metric& metric() const { return metric_; }
  int negative() const { return negative_; }
  const ContactSet& closed() const { return closed_; }
  /// Length of the next step, and of the shortest that is tried.
  double step() const { return step_; }
  double shortest() const { return shortest_; }

 private:
  struct Candidate {
    double s;
    Equilibrium e;
    std::optional<Event> event;
    std::optional<double> stop;
  };
  double longest() const;
  std::optional<Candidate> reach(const Arc& arc, double s, std::string& why);
  std::optional<Candidate> reach_corner(const Arc& arc, double s);
  Candidate with_contact(Candidate c, ContactChange change) const;
  bool find_contact(const Segment& segment, Candidate& c, std::string& why);
  bool find_critical(Segment segment, const Arc& arc, Candidate& c, std::string& why);
  void find_stop(Segment segment, const Arc& arc, Candidate& c);
  void weigh(const Equilibrium& e, Direction& direction);
  Waypoint accept(Candidate c, const Arc& arc);

  Newton& newton_;
  Metric metric_;
  WalkOptions options_;
  Equilibrium current_;
  Direction direction_;
  int negative_, sign_;                // Morse index, and of dλ/ds, from here on
  ContactSet closed_;
  std::vector<double> side_;           // of every watch: observable − value from here on
  std::optional<double> last_stop_;    // where it stands, if at a stop
  double step_, shortest_, least_length_;
  Status status_ = Status::converged;
  std::string why_;
};

}  // namespace elamin
