#pragma once
#include "path/path.hpp"
#include "path/switching.hpp"
#include "path/walk.hpp"

namespace elamin {

/// L and Λ for a diagram that begins at an equilibrium: Λ = |to − from|, and L so that load factor and positions weigh alike
/// there, but not less than 10⁻⁶ of the structure's extent.
Metric metric_for(const Energy& energy, const Equilibrium& start, const PathOptions& options);

/// What a walk within these options may do.
WalkOptions walk_options(const PathOptions& options);

/// One branch in steps of arc length, stable or not, through limit points and over branch points. It ends where the load
/// factor reaches `to` or leaves [lowest, highest] (default: from − 2 (to − from) to `to`), at a watch that stops, at a
/// branch point of the diagram that it was not sent from, where it closes to a loop, or after most_points.
/// when_unstable: follow goes on; stop ends where stability is lost; jump falls to the next minimum there and goes on from
/// that, the load factor towards `to`.
class ArcLength : public Path {
 public:
  /// The first branch of a diagram: from the equilibrium at `from` (or at `start`), the load factor towards `to`.
  ArcLength(Newton& newton, const State& start, PathOptions options, Numbering* numbering = nullptr);
  /// A branch that was switched to.
  ArcLength(Newton& newton, SideBranch side, std::string parent, const std::vector<Event>& known, Metric metric,
            PathOptions options, Numbering* numbering);

  /// Of the known branch points the one that this branch ended at, and along what it arrived; else −1.
  int arrived_at() const { return arrived_at_; }
  const Vector& arrival() const { return arrival_; }
  const Metric& metric() const { return metric_; }

 protected:
  void advance() override;

 private:
  void begin();
  void set_out(const Equilibrium& from, const Direction& direction, int negative, ContactSet closed, double step = 0, double shortest = 0);
  void take_up(Equilibrium at, const Resume& resume);
  Resume resume_here(const Waypoint& waypoint) const;
  void show(Waypoint waypoint);
  bool lose_stability(Event& event);
  bool meets_known(const Waypoint& waypoint, const Event& event);
  bool closes_loop(const Waypoint& waypoint);

  Newton& newton_;
  PathOptions options_;
  State start_;
  std::optional<SideBranch> side_;
  std::vector<Event> known_;
  Metric metric_;
  std::optional<Walk> walk_;
  Equilibrium first_;                    // where the loop would close
  Direction first_direction_;
  bool left_ = false;                    // has been well away from there
  double travelled_ = 0;                 // the farthest that it has been away, in the metric
  int points_ = 0;
  int arrived_at_ = -1;
  Vector arrival_;
};

}  // namespace elamin
