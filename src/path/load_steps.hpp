#pragma once
#include "path/arc_steps.hpp"
#include "path/load_grid.hpp"

#include <limits>

namespace elamin {

/// Load factors to hit, in order: the even steps and the stops asked for.
std::vector<double> load_targets(const PathOptions& options);

/// The load factor at which a snap behind an event begins: a part of the range farther on, or half as far as a stop or an end of the path, whatever
/// the steps. What is nearer than a snap may begin is not looked at; so near to its end it begins there.
double snap_begins(const PathOptions& options, double at, double part);

/// A branch in steps of the load factor. Steps that fail are halved, down to 2⁻²⁰ of a step; halved steps double again, so
/// that every multiple of the step is hit. Where steps fail, the branch is followed in arc length to see what is there: a limit point, a
/// branch point that is reached along a side branch, or only a sharp bend. Where something touches and nobody asks for contacts, a path that may
/// jump has no patience with what lies nearer together than steps can tell: it stops there, and snaps.
class LoadSteps final : public Branch {
 public:
  LoadSteps(Newton& newton, Departure from, const PathOptions& options);

  std::optional<Waypoint> next() override;
  void carry(Archive& archive) override;
  /// Where the next step would lead.
  double goal() const { return grid_.done() ? current_.point.state.load_factor : grid_.next(); }
  using Branch::searches;
  /// From now on what happens on a step is searched for; false if it was before.
  [[nodiscard]] bool search();

 private:
  [[nodiscard]] std::optional<Candidate> reach(double target, std::string& why);
  [[nodiscard]] std::optional<Candidate> meet(double target);
  bool way_is_free(double target) const;
  bool ends_on_event(const Candidate& c) const;
  bool may_hide_limits(const Candidate& c);
  Waypoint accept(Candidate c);
  void set_out_on_detour(double limit = infinity);
  [[nodiscard]] std::optional<Waypoint> on_detour();
  void arrived(const Candidate& c);
  bool patient() const { return patience_.most == 0 || patience_.refused < patience_.most; }

  LoadGrid grid_;
  Corrector correct_;
  Eigen::MatrixXd critical_;             // modes of the branch point where it stands
  std::optional<ArcSteps> detour_;
  double goal_ = 0;                      // of the detour …
  double met_ = std::numeric_limits<double>::quiet_NaN();                // the load factor at which what floats last met something
  int taken_ = 0;                        // … and its steps so far
  struct Patience {                      // with steps that are refused, until the load factor has gone on by `creep` or something happened
    int most = 0;                        // 0: without end
    double creep = 0, since = 0;
    int refused = 0;
  } patience_;
};

}  // namespace elamin
