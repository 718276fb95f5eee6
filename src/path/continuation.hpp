#pragma once
#include "path/arc_steps.hpp"
#include "path/load_steps.hpp"
#include "path/path.hpp"
#include "path/switching.hpp"

namespace elamin {

/// The continuation driver: one branch by load steps or in arc length (options.method), and the branches that it snaps to. It tells the
/// points and labelled events, and decides what comes after an event: the end, the same branch, or a snap.
///
/// A branch ends where the load factor reaches `to`, at a user event that stops, where it cannot be followed any further; in arc length also where
/// the load factor leaves [lowest, highest] (default: from − 2 (to − from) to `to`), at a branch point of the diagram that it was not sent from,
/// where it closes to a loop, or after most_points; by load steps at a limit point that it is to follow.
/// when_unstable: follow goes on; stop ends where stability is lost; jump snaps to the next minimum there and goes on from
/// that, the load factor towards `to`.
class Continuation : public Path {
 public:
  /// The first branch of a diagram: from the equilibrium at `from` (or at `start`), the load factor towards `to`.
  Continuation(Newton& newton, const State& start, PathOptions options, Numbering* numbering = nullptr);
  /// A branch that was switched to, in arc length.
  Continuation(Newton& newton, SideBranch side, std::string parent, const std::vector<Event>& known, Metric metric,
               PathOptions options, Numbering* numbering);

  /// Of the known branch points the one that this branch ended at, and along what it arrived; else −1.
  int arrived_at() const { return arrived_at_; }
  const Vector& arrival() const { return arrival_; }
  /// Of a branch that has begun, or of the first one.
  void carry(Archive& archive) override;

 protected:
  void advance() override;

 private:
  bool arcs() const { return options_.method == PathMethod::arc_length; }
  const ArcSteps& arc_steps() const { return static_cast<const ArcSteps&>(*steps_); }
  LoadSteps& load_steps() { return static_cast<LoadSteps&>(*steps_); }
  double range() const { return options_.to - options_.from; }
  Direction towards_end(const Equilibrium& e) const;
  void begin();
  [[nodiscard]] Equilibrium back_from_limit(Equilibrium limit);
  void take_up(Equilibrium at, const Resume& resume);
  void set_out(Departure from, const Direction& direction = {}, double step = 0, double shortest = 0);
  void show(Waypoint waypoint);
  std::optional<Resume> resume_here(const Waypoint& waypoint) const;
  bool goes_on_behind(Event& event);
  double left_of_path(double at) const;
  bool at_end(double load) const;
  void end_reached();
  [[nodiscard]] bool slides_away(Equilibrium at);
  [[nodiscard]] bool crosses_over(const Event& event);
  void jump(const Event& event);
  [[nodiscard]] bool moves_in_family(Equilibrium& at);
  void begin_anew(Equilibrium& at);
  void begin_at(Equilibrium& at);
  void land(Equilibrium at, const std::string& what, int before, const std::string& parent);
  void break_off();
  [[nodiscard]] bool snap(std::string& why);
  [[nodiscard]] bool comes_back(const Equilibrium& landed, const Equilibrium& from);
  bool meets_known(const Waypoint& waypoint, const Event& event);
  bool closes_loop(const Waypoint& waypoint);

  Newton& newton_;
  PathOptions options_;
  State start_;
  std::optional<SideBranch> side_;
  std::vector<Event> known_;
  Metric metric_;
  std::unique_ptr<Branch> steps_;
  Equilibrium first_;                    // where the loop would close
  Direction first_direction_;
  bool left_ = false;                    // has been well away from there
  double travelled_ = 0;                 // the farthest that it has been away, in the metric
  int points_ = 0;
  int family_ = 0;                       // most directions of a family that a snap may lead to: of a multiple branch point all of its modes but one
  int arrived_at_ = -1;
  Vector arrival_;
};

}  // namespace elamin
