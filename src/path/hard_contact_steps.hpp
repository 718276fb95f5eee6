#pragma once
#include "path/path.hpp"
#include "solve/contact_equilibrium.hpp"

namespace elamin {

/// A branch in steps of the load factor where there are hard contacts. While the same ones are closed the branch is smooth:
/// tangent predictor, Newton's method on ContactEquilibrium. Where gaps or forces would become negative, contacts are made or
/// lost: one event, at the root of the first of them, for all that vanish there. Which of these are closed behind, their rates
/// along the branch tell (ContactEquilibrium::onward). What vanishes at the end of a step, within rounding, is an event there; what
/// vanishes where the path begins is none. What Newton's method does not find, Ipopt looks for.
///
/// Steps that fail are halved, down to 2⁻¹² of a step. Where the branch turns unstable the branch point or limit point is located; what
/// cannot be located, and where no step can be made, is told by a note. Under `jump` the state then snaps to the minimum that Ipopt
/// finds a fixed part of the path beyond.
class HardContactSteps final : public Path {
 public:
  HardContactSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering = nullptr);
  void carry(Archive& archive) override;

 protected:
  void advance() override;

 private:
  using Contacts = std::vector<HardForce>;
  /// Contacts at an equilibrium whose force, or gap, is below zero; and those that have neither, within rounding.
  struct Judgement { Contacts wrong, slack; };
  void begin();
  void step();
  Equilibrium follow(const Equilibrium& from, const Contacts& closed, double load_factor);
  Judgement judge(const Equilibrium& e, const Equilibrium* before);
  double margin(const HardForce& contact, const Equilibrium& e) const;
  [[nodiscard]] std::optional<Equilibrium> first_change(const Contacts& wrong, const Equilibrium& candidate);
  [[nodiscard]] bool turn_back(const HardForce& contact);
  void kink(Equilibrium at, const Contacts& slack);
  void change(Equilibrium at, Contacts now, const Contacts& slack);
  void go_on(Equilibrium from);
  double direction() const { return options_.to < options_.from ? -1 : 1; }
  struct Vanishing { Equilibrium at; double scale; };          // of a mode's curvature, and how large it is beside that
  [[nodiscard]] std::optional<Event> branch_point(Equilibrium candidate);
  [[nodiscard]] std::optional<Vanishing> crossing(const Equilibrium& candidate);
  [[nodiscard]] std::optional<Event> limit_point(double target);
  Event critical(Equilibrium at, EventKind kind, int after, double scale);
  void lose(Event event);
  void miss(double target, int after);
  void leave_unstable();
  void halve(double target, const std::string& why);
  void snap(const std::string& why, bool stability_lost);
  void accept(Equilibrium at, const Contacts& slack, const std::vector<Event>& passed = {});
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
  Contacts slack_;                       // with neither gap nor force at current_
  std::vector<double> side_;             // of every user event: observable − value from current_ on
  int changes_ = 0;                      // of contacts at this load factor
  bool begun_ = false;
};

}  // namespace elamin
