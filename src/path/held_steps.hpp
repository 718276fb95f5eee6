#pragma once
#include "path/path.hpp"
#include "solve/contact_equilibrium.hpp"

namespace elamin {

/// A branch in steps of the load factor where there are hard contacts. While the same ones are closed the branch is smooth:
/// tangent predictor, Newton's method on ContactEquilibrium. Where a gap would become negative, or a force, the contact is made or
/// lost: an event, at the root of that gap or force, and the branch goes on with the other contacts. What Newton's method
/// does not find, Ipopt looks for.
///
/// Steps that fail are halved, down to 2⁻¹² of a step. Where the branch turns unstable, or no step can be made, this is told by
/// a note, with the load factors between which it happens; under `jump` the state then falls to the minimum that Ipopt finds.
class HeldSteps final : public Path {
 public:
  HeldSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering = nullptr);

 protected:
  void advance() override;

 private:
  using Contacts = std::vector<HardForce>;
  void begin();
  void step();
  Equilibrium follow(const Equilibrium& from, const Contacts& closed, double load_factor);
  /// Those whose force, or whose gap, is below zero.
  Contacts wrong(const Contacts& closed, const Equilibrium& e);
  double margin(const Contacts& closed, const HardForce& contact, const Equilibrium& e) const;
  bool meet(Equilibrium candidate, double target);
  void lose(double target, int after);
  void leave_unstable();
  void halve(double target, const std::string& why);
  void fall(double target, const std::string& why);
  void accept(Equilibrium at, double load_factor, const std::vector<Event>& passed = {});
  void tell(PathPoint point);

  Newton& newton_;
  ContactEquilibrium equilibrium_;
  PathOptions options_;
  State start_;
  std::vector<double> targets_;
  std::size_t interval_ = 0;             // towards targets_[interval_]
  int halvings_ = 0;                     // of the way to there
  Equilibrium current_;
  Contacts closed_;                      // from current_ on; some may not bear a force yet
  std::vector<double> side_;             // of every watch: observable − value from current_ on
  int changes_ = 0;                      // of contacts where some have just changed
  bool begun_ = false;
};

}  // namespace elamin
