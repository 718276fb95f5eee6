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
  std::vector<double> sides;           // of every watch: observable − value from the start on, 0: not known; none: as the state tells
  std::string told;                    // label of the event that it begins at: a watch's own side is not known there
  double step = 0, shortest = 0;       // of the first step, in the metric; 0: as long as the limits above let it be
};

/// What a step led to: the next equilibrium, what happens there, or a stop.
struct Waypoint {
  Equilibrium at;
  std::vector<Event> events;           // all at this point, the one that decides how the branch goes on first
  std::optional<double> stop;          // the load factor of the stop that was met
};

/// Follows a branch, stable or not, through limit points and over branch points. Steps are as long as the corrector's
/// iterations (4 are aimed at), the change of the branch's direction (0.25 rad) and the options allow.
///
/// Where a contact is made that is much stiffer than what it presses on, the branch has a corner that no step resolves: beyond the event
/// the next equilibrium is then found by a small step of the load factor, with the same contacts closed and the same Morse index.
///
/// A step from a to b is taken to have stayed on its branch where
/// - the corrector leaves the tangent at a by no more than half a step;
/// - the chord is parallel to the sum of the tangents at a and b, as it is, up to the third order in the step, on a smooth curve;
/// - the Morse index and the sign of dλ/ds are the same at a and b, or their change is explained by an event between them from which
///   the branch leads back to a and on to b. The determinant of the bordered matrix [H c; t_x/L² t_λ/Λ²] keeps its sign on a smooth
///   branch (Keller 1977), so a step onto a branch that only passes by, as beside a pitchfork that a small force has unfolded, shows as a
///   change of the index for which there is no event: the step is halved.
class Walk {
 public:
  /// From an equilibrium along a direction; negative: the Morse index beyond it, −1: not known, as at a branch point that a side branch
  /// leaves; closed: the contacts.
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
  /// Of the last one; 0: it was not one of arc length.
  double taken() const { return taken_; }
  double shortest() const { return shortest_; }

 private:
  struct Candidate {
    double s;
    Equilibrium e;
    std::vector<Event> events;
    std::optional<double> stop;
    bool over = false;                 // a contact that has just been made or lost, in one step of the load factor
  };
  double longest() const;
  std::optional<Candidate> reach(const Arc& arc, double s, std::string& why);
  std::optional<Candidate> reach_corner(const Arc& arc, double s);
  std::optional<Candidate> step_over_contact();
  void carry_neutral(Equilibrium& e);
  bool stays_on_branch(const Arc& arc, double s, const Equilibrium& e, std::string& why) const;
  bool look_beyond(const Arc& arc, const Candidate& c);
  Candidate with_contact(Candidate c, ContactChange change) const;
  bool find_contact(const Segment& segment, Candidate& c, std::string& why);
  bool find_critical(Segment segment, const Arc& arc, Candidate& c, std::string& why);
  bool joins(const Event& event, const Equilibrium& end, const Arc& arc) const;
  bool find_watches(Segment segment, Candidate& c, std::string& why);
  void find_stop(Segment segment, const Arc& arc, Candidate& c);
  Equilibrium at_load(const Equilibrium& from, double load_factor);
  void weigh(const Equilibrium& e, Direction& direction);
  Waypoint accept(Candidate c, const Arc& arc);

  Newton& newton_;
  Metric metric_;
  WalkOptions options_;
  Equilibrium current_;
  Direction direction_;
  int negative_, sign_;                // Morse index, and of dλ/ds, from here on
  Eigen::MatrixXd neutral_;            // zero modes of it that are no motions of rigid parts (dofs × count)
  bool singular_ = false;              // it stands at a limit point or branch point …
  bool at_contact_ = false;            // … or where a contact is made or lost
  ContactSet closed_;
  std::vector<double> side_;           // of every watch: observable − value from here on
  std::optional<double> last_stop_;    // where it stands, if at a stop
  double step_, shortest_, least_length_, taken_ = 0;
  Status status_ = Status::converged;
  std::string why_;
};

}  // namespace elamin
