#pragma once
#include "path/arc.hpp"
#include "path/branch.hpp"

namespace elamin {

struct ArcOptions {
  double load_step = 0.01;             // no step changes the load factor by more
  double rotation = 0.05;                  // … nor turns or stretches a bond by more (rad)
  bool contacts = true, event_errors = false;
  std::vector<double> stops = {};      // load factors at which it stops on the way
  std::vector<UserEvent> user_events = {};
  int patience = 0;                    // steps that may be refused altogether; 0: as many as it takes
  double step = 0, shortest = 0;       // of the first step, in the metric; 0: as long as the limits above let it be
};

/// What steps of arc length within a path's options may do.
ArcOptions arc_options(const PathOptions& options);

/// L and Λ for a diagram that begins at an equilibrium: Λ = |to − from|, and L so that load factor and positions weigh alike
/// there, but not less than 10⁻⁶ of the structure's extent.
Metric metric_for(const Energy& energy, const Equilibrium& start, double load_range);

/// A branch in steps of arc length, stable or not, through limit points and over branch points. Steps are as long as the corrector's
/// iterations (4 are aimed at), the change of the branch's direction (0.25 rad) and the options allow.
///
/// A step from a to b is taken to have stayed on its branch where the corrector leaves the tangent at a by no more than half a step, the
/// chord is parallel to the sum of the tangents at a and b, as it is, up to the third order in the step, on a smooth curve, and the Morse index and the sign
/// of dλ/ds are the same at a and b or explained (see Branch).
///
/// Where contacts are made that are much stiffer than what they press on, the branch has corners that no step of arc length along its tangent resolves:
/// there a step goes along the contact as if it were rigid (along_contacts), or steps of the load factor go on, in the direction in which it was going.
class ArcSteps final : public Branch {
 public:
  ArcSteps(Newton& newton, Departure from, Direction direction, Metric metric, ArcOptions options);

  std::optional<Waypoint> next() override;
  void carry(Archive& archive) override;

  const Direction& direction() const { return direction_; }
  /// As it is now: L falls to the least Λ |dx/dλ| that is met.
  const Metric& metric() const { return metric_; }
  /// Length of the next step, and of the shortest that is tried.
  double step() const { return step_; }
  double shortest() const { return shortest_; }
  /// Steps that have been refused so far.
  int refused() const { return refused_; }
  /// Of the last one; 0: it was not one of arc length.
  double taken() const { return taken_; }

 private:
  double longest() const;
  bool still_closed(const Equilibrium& e);
  bool over_bend(const Candidate& c);
  [[nodiscard]] std::optional<Candidate> attempt(double s, const Direction& towards, bool along_contact, int& shifts, double& better, std::string& why);
  [[nodiscard]] std::optional<Candidate> reach(const Arc& arc, double s, std::string& why);
  [[nodiscard]] std::optional<Candidate> reach_kink(const Arc& arc, double s, std::optional<Segment>& fading);
  [[nodiscard]] std::optional<Segment> fades(const ContactChange& change, const Equilibrium& lost);
  bool others_change(const Equilibrium& e) const;
  bool stays_on_branch(const Arc& arc, double s, const Equilibrium& e, std::string& why) const;
  [[nodiscard]] bool look_beyond(const Arc& arc, const Candidate& c);
  void carry_neutral(Equilibrium& e);
  /// The equilibrium at a place of an arc, neutral where the branch is.
  [[nodiscard]] Equilibrium on(const Arc& arc, double t, const Equilibrium& nearest);
  bool joins(const Arc& arc, const Equilibrium& start, const Equilibrium& end) const;
  double apart(const State& a, const State& b) const;
  double next_load(double part) const;
  bool stands_at(const Equilibrium& e, double stop) const;
  [[nodiscard]] bool find_stop(Segment segment, Candidate& c, std::string& why);
  Equilibrium at_load(const Equilibrium& from, double load_factor);
  std::optional<Equilibrium> foreseen(const Segment& segment, const Candidate& c, double load_factor);
  Waypoint accept(Candidate c);
  void rotate(const Candidate& c);
  void tell_tangent();
  [[nodiscard]] std::optional<Direction> along_contact();
  void weigh(const Equilibrium& e);

  Metric metric_;
  ArcOptions options_;
  Direction direction_;
  std::vector<ContactKey> just_made_;  // where it stands, if steps go along them
  bool kink_refused_ = false;          // no critical point was found before the kink ahead: shorter steps would look for the same one
  std::optional<double> last_stop_;    // where it stands, if at a stop
  double step_, shortest_, least_length_, taken_ = 0;
  int refused_ = 0;
};

}  // namespace elamin
