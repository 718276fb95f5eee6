#pragma once
// A branch as an iterator over its equilibria, with what happens between them located.
#include "core/archive.hpp"
#include "path/event.hpp"
#include "path/options.hpp"

#include <optional>
#include <vector>

namespace elamin {

/// What a step led to: the next equilibrium, what happens there, or a stop.
struct Waypoint {
  Equilibrium at;
  std::vector<Event> events = {};           // all at this point, the one that decides how the branch goes on first
  std::optional<double> stop = {};          // the load factor of the stop that was met
};

/// Where a branch is taken up.
struct Departure {
  Equilibrium at = {};
  int negative = -1;                        // Morse index from here on; −1: not known, as at a branch point that a side branch leaves
  ContactSet closed;                        // contacts from here on
  bool singular = false;                    // it is a limit point or branch point …
  bool at_contact = false;                  // … or a place where a contact is made or lost
  std::vector<double> sides = {};           // of every user event: observable − value from here on, 0: not known; none: as the state tells
  ContactSet changed = {};                  // contacts that have been made or lost here
};

/// The steps of a branch are a strategy's (load_steps.hpp, arc_steps.hpp); what happens on a step is found here, the same for all:
/// contacts made and lost, limit points and branch points, observables of user events at their values. All on one step are found, the first is told.
///
/// A change of the Morse index is explained by an event between the ends of the step from which the branch leads back to the one and on to the other, or
/// the step is refused: the determinant of the bordered matrix [H c; t_x/L² t_λ/Λ²] keeps its sign on a smooth branch (Keller 1977), so a step onto
/// a branch that only passes by, as beside a pitchfork that a small force has unfolded, shows as a change of the index for which there is no event.
class Branch {
 public:
  virtual ~Branch() = default;
  Branch(const Branch&) = delete;
  Branch& operator=(const Branch&) = delete;

  /// The next waypoint; nothing at the end, or where the branch cannot be followed any further: status() and why() say which.
  virtual std::optional<Waypoint> next() = 0;
  Status status() const { return status_; }
  const std::string& why() const { return why_; }

  const Equilibrium& at() const { return current_; }
  int negative() const { return negative_; }
  const ContactSet& closed() const { return closed_; }

  /// What goes on from step to step, but for what the options tell.
  virtual void carry(Archive& archive);

 protected:
  Branch(Newton& newton, Departure from, bool contacts, bool event_errors, std::vector<UserEvent> user_events);

  struct Candidate {
    double parameter;                  // on the segment from here
    Equilibrium e;
    std::vector<Event> events = {};
    std::optional<double> stop = {};
    bool natural = false;              // a step of the load factor
    bool stands = false;               // a contact changes all but where the step begins: nothing lies between
  };
  /// The event that decides how the branch goes on behind a candidate; none if there are only user_events.
  static const Event* deciding(const Candidate& c);
  static bool is_critical(const Event* event) { return event && !event->beyond && (event->kind == EventKind::limit || event->kind == EventKind::branch); }

  /// The equilibrium at a load factor, if it is on the same branch; the same with what happens before it; both in one call.
  [[nodiscard]] std::optional<Candidate> corrected(const Equilibrium& from, double target, std::string& why, const Corrector& correct = {});
  [[nodiscard]] std::optional<Candidate> with_events(Candidate c, std::string& why);
  [[nodiscard]] std::optional<Candidate> reach_load(const Equilibrium& from, double target, std::string& why, const Corrector& correct = {});
  /// Where the branch is, with the tangent behind a contact that has just changed: that of an equilibrium which is farther by `way` of the load factor, or less.
  Equilibrium past_contact(double way);
  /// Equilibria between here and the candidate lie beside the chord.
  Segment beside(Segment segment, const Candidate& c) const;
  Candidate with_contact(Candidate c, ContactChange change) const;
  void look_behind(Event& contact, double way);
  void see_neutral_behind(Event& contact, double way);
  bool undoes(const ContactChange& change) const;
  bool changes_before(const ContactChange& change);
  using Along = std::function<Equilibrium(double parameter, const Equilibrium& nearest)>;
  std::optional<Candidate> before_it_leaves(const Along& at, double from, double where, const ContactSet& after) const;
  bool contact_may_explain(const Candidate& c) const;
  bool stop_where_contact_passes(const Segment& segment, Candidate& c);
  struct Place { double t, by; };      // on a segment, and how likely: the less the more
  using Where = std::function<std::optional<Place>(double ta, const Equilibrium& a, double tb, const Equilibrium& b)>;
  std::optional<bool> look_between(const Segment& segment, Candidate& c, const Where& where, const std::function<bool(Equilibrium&)>& wanted) const;
  bool stop_where_load_goes_back(const Segment& segment, Candidate& c);
  bool goes_back(const Candidate& c) const;
  bool goes_on(const Candidate& c) const;
  bool goes_on_behind(const Candidate& c) const;
  [[nodiscard]] bool stop_where_index_goes_back(const Segment& segment, Candidate& c);
  double way_to_limit() const;
  bool softens() const;
  /// see_softest() where the factors are those of another state.
  void see_softest_anew(Equilibrium& e, const EigenPairs& neighbour, double change);
  /// Tells the softest eigenpairs where the step begins, if they are told at its end alone; `change`: the load factor over which their change is taken.
  void see_softest_here(const Candidate& c, double change);
  /// Whether what happens on the next step is searched for. What floats and bears no force cannot go on without.
  bool searches() const { return searches_ || (current_.slack && current_.point.stability.zero > 0); }
  /// What happens on the way to a candidate, which is then where that is.
  [[nodiscard]] bool find_events(const Segment& segment, Candidate& c, std::string& why);
  [[nodiscard]] bool find_contact(Segment segment, Candidate& c, std::string& why);
  [[nodiscard]] bool find_critical(Segment segment, Candidate& c, std::string& why);
  bool explained(const Event& event, const Segment& segment, const Candidate& c) const;
  bool turns_back(const Event& limit) const;
  [[nodiscard]] bool find_user_events(Segment segment, Candidate& c, std::string& why);
  /// The branch is at the candidate from now on.
  void take(const Candidate& c);
  void stop_here(Status status, std::string why) { status_ = status, why_ = std::move(why); }

  Newton& newton_;
  Equilibrium current_;
  int negative_, sign_ = 1;            // Morse index, and of dλ, from here on; the strategy tells the sign
  Eigen::MatrixXd neutral_;            // zero modes of it that are no motions of rigid parts (dofs × count)
  bool singular_, at_contact_;
  ContactSet closed_, changed_;
  bool contacts_, event_errors_;
  std::vector<UserEvent> user_events_;
  std::vector<double> side_;
  bool searches_ = true;               // for what happens on a step, but for user events
  Vector soft_before_;                 // Equilibrium::soft_values a step before; empty: not known
  double load_before_ = 0;             // … and the load factor there

 private:
  Status status_ = Status::converged;
  std::string why_;
};

}  // namespace elamin
