#include "path/held_steps.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/load_steps.hpp"
#include "path/locate.hpp"
#include "path/root.hpp"
#include "solve/method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr int finest = 12;                          // halvings of a step
constexpr int most_changes = 20;                    // of contacts at one load factor
constexpr double beyond_event = 0.1;                // of the way to the next step: where a fall begins
constexpr double rounding = 1e-12;                  // of a diameter, of the largest force

bool in(const std::vector<HardForce>& contacts, const HardForce& contact) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const HardForce& h) { return key(h) == key(contact); });
}

double force_of(const State& state, const HardForce& contact) {
  for (const HardForce& h : state.hard)
    if (key(h) == key(contact)) return h.force;
  return 0;
}

// Who touches or leaves whom.
std::string told(const Model& model, const HardForce& h, bool made) {
  const std::string one = fmt::format("particle {}", model.id[h.particle]);
  if (h.wall >= 0) return one + (made ? " touches wall " : " leaves wall ") + model.walls[h.wall].name;
  return one + (made ? " touches particle " : " leaves particle ") + std::to_string(model.id[h.other]);
}

}  // namespace

HeldSteps::HeldSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), equilibrium_(newton.energy()), options_(std::move(options)), start_(start),
      targets_(load_targets(options_)) {}

void HeldSteps::advance() {
  if (!begun_) begin();
  else step();
}

void HeldSteps::begin() {
  begun_ = true;
  const double at = options_.start.value_or(options_.from);
  State state = start_;
  newton_.energy().kinematics().prescribe(state, at);
  Report report;
  if (!state.hard.empty()) {                                    // a state that was stored, perhaps
    State near = state;
    report = equilibrium_.correct(near, newton_.tolerance(), nullptr, 1e-3 * newton_.energy().model().diameter[0]);
    if (report.converged()) state = near;
  }
  if (!report.converged()) report = minimise(newton_, state, IpoptOptions{.tolerance = newton_.tolerance()});
  if (!report.converged()) return end(report.status, fmt::format("no equilibrium at the start, load factor {:.10g}: {}", at, report.why));
  Equilibrium first = assess(newton_, state, report);
  first.point.label = "initial";
  tell(first.point);
  first.point.label.clear();
  closed_ = state.hard;
  accept(std::move(first), at);
}

// Forces that are nothing are not told.
void HeldSteps::tell(PathPoint point) {
  const double least = rounding * newton_.energy().force_scale();
  std::erase_if(point.state.hard, [&](const HardForce& h) { return !(h.force > least); });
  emit(std::move(point));
}

void HeldSteps::accept(Equilibrium at, double load_factor, const std::vector<Event>& passed) {
  current_ = std::move(at);
  side_.resize(options_.watches.size(), 0);
  pass_watches(options_.watches, passed, current_.point.state, side_);
  if (interval_ < targets_.size() && load_factor == targets_[interval_]) ++interval_;
}

// The equilibrium at the load factor with these contacts closed, whatever their forces.
Equilibrium HeldSteps::follow(const Equilibrium& from, const Contacts& closed, double load_factor) {
  Energy& energy = newton_.energy();
  State state = from.point.state;
  const double change = load_factor - state.load_factor;
  energy.kinematics().prescribe(state, load_factor);
  energy.kinematics().retract(state, from.tangent, change);
  state.hard = closed;
  for (HardForce& h : state.hard) h.force = force_of(from.point.state, h);
  Report report = equilibrium_.settle(state, newton_.tolerance(), &from.point.state);
  if (report.converged() && energy.passage(from.point.state, state) < 1)
    report.status = Status::not_converged, report.why = "the step would carry something through something else";
  if (report.converged()) return assess(newton_, state, report);
  Equilibrium failed;
  failed.point.state = state, failed.point.report = report;
  return failed;
}

// Below zero: the force of a contact that is closed, in parts of the largest; the gap of another one, in diameters.
double HeldSteps::margin(const Contacts& closed, const HardForce& contact, const Equilibrium& e) const {
  const Model& model = newton_.energy().model();
  if (in(closed, contact)) return force_of(e.point.state, contact) / newton_.energy().force_scale();
  HardGap gap;
  return hard_gap(model, contact, e.point.state, gap) ? gap.value / model.diameter[contact.particle] : 1.0;
}

HeldSteps::Contacts HeldSteps::wrong(const Contacts& closed, const Equilibrium& e) {
  Contacts found;
  newton_.energy().evaluate(e.point.state, false);              // its force scale
  for (const HardForce& h : closed)
    if (margin(closed, h, e) < -rounding) found.push_back(h);
  for (const HardForce& h : newton_.energy().hard_contacts(e.point.state, 0))
    if (!in(closed, h) && margin(closed, h, e) < -rounding) found.push_back(h);
  return found;
}

// No step is cut in two that are very unequal.
void HeldSteps::step() {
  const double here = current_.point.state.load_factor;
  if (interval_ == targets_.size()) return end(Status::converged, fmt::format("load factor {:.10g} reached", options_.to));
  if (interrupted()) return end(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", here));
  const double goal = targets_[interval_];
  const double step = std::ldexp((options_.to - options_.from) / options_.steps, -halvings_);
  const double target = std::abs(goal - here) <= 1.25 * std::abs(step) ? goal : here + step;

  Equilibrium candidate = follow(current_, closed_, target);
  if (!candidate.point.report.converged()) return halve(target, candidate.point.report.why);
  if (!wrong(closed_, candidate).empty()) {
    if (!meet(candidate, target)) halve(target, "contacts change in a way that could not be located");
    return;
  }
  const int after = candidate.point.stability.negative;
  if (after != current_.point.stability.negative) return lose(target, after);
  if (!same_branch(newton_.energy(), current_, candidate) && halvings_ < finest) return halve(target, "the corrector went to another branch");
  const auto between = [&](double t, const Equilibrium& nearest) { return follow(nearest, closed_, t); };
  bool missed = false;
  Segment segment = segment_of_loads(newton_, here, target);
  segment.at = between;
  std::vector<Event> seen = locate_watches(options_.watches, side_, segment, current_, candidate, after, missed);
  if (missed && halvings_ < finest) return halve(target, "where an observable reaches its value could not be located");
  if (!seen.empty()) {
    const double there = seen.front().at_parameter;
    for (Event event : seen) {
      std::erase_if(event.at.point.state.hard, [](const HardForce& h) { return !(h.force > 0); });
      emit(event);
    }
    accept(seen.front().at, there, seen);
    for (const Event& event : seen)
      if (options_.watches[event.watch].stop) return end(Status::converged, fmt::format("{} reached at load factor {:.10g}", event.what, there));
    return;
  }
  changes_ = 0;
  halvings_ = std::max(0, halvings_ - 1);
  tell(candidate.point);
  accept(std::move(candidate), target);
}

// The first contact that is made or lost on the way to the candidate, and the branch behind it. False if it cannot be found.
bool HeldSteps::meet(Equilibrium candidate, double target) {
  const double here = current_.point.state.load_factor;
  std::optional<HardForce> first;
  for (;;) {                                                    // the one that is first, as far as straight lines tell
    std::optional<HardForce> next;
    double least = 2;
    for (const HardForce& h : wrong(closed_, candidate)) {
      if (first && key(*first) == key(h)) continue;
      const double a = margin(closed_, h, current_), b = margin(closed_, h, candidate);
      const double part = a > 0 ? a / (a - b) : 0.0;
      if (part < least) least = part, next = h;
    }
    if (!next) break;
    first = next;
    const double a = margin(closed_, *first, current_), b = margin(closed_, *first, candidate);
    if (!(a > rounding)) {                                      // it changes here, at an event that has been told
      candidate = current_;
      break;
    }
    const auto zero = find_zero({here, a, current_}, {candidate.point.state.load_factor, b, candidate}, 1e-13 * std::abs(target - here),
                                [&](double t, const Sample& near) -> std::optional<Sample> {
      const Equilibrium e = follow(near.e, closed_, t);
      if (!e.point.report.converged()) return {};
      newton_.energy().evaluate(e.point.state, false);
      return Sample{t, margin(closed_, *first, e), e};
    });
    if (!zero) return false;
    candidate = zero->e;
  }
  const bool told_already = candidate.point.state.load_factor == here;
  if (!first || (told_already && ++changes_ > most_changes)) return false;
  const int before = current_.point.stability.negative;
  if (candidate.point.stability.negative != before) {           // that comes first
    lose(candidate.point.state.load_factor, candidate.point.stability.negative);
    return true;
  }
  const bool made = !in(closed_, *first);
  Contacts now = closed_;
  if (made) now.push_back({first->particle, first->other, first->wall, first->face, 0});
  else std::erase_if(now, [&](const HardForce& h) { return key(h) == key(*first); });
  std::sort(now.begin(), now.end(), [](const HardForce& a, const HardForce& b) { return key(a) < key(b); });
  State state = candidate.point.state;
  state.hard = now;
  for (HardForce& h : state.hard) h.force = force_of(candidate.point.state, h);
  const double load = state.load_factor;
  Equilibrium behind = assess(newton_, state, candidate.point.report);
  if (options_.contacts && !told_already) {
    Event event;
    event.kind = EventKind::contact, event.what = told(newton_.energy().model(), *first, made);
    event.at = candidate;
    event.before = before, event.after = behind.point.stability.negative;
    std::erase_if(event.at.point.state.hard, [&](const HardForce& h) { return !(h.force > 0) || key(h) == key(*first); });
    emit(event);
  }
  closed_ = std::move(now);
  halvings_ = std::max(0, halvings_ - 1);
  const int after = behind.point.stability.negative;
  accept(std::move(behind), load);
  if (after > before) {
    note(fmt::format("load factor {:.10g}: with the contacts, the number of negative eigenvalues goes from {} to {}", load, before, after));
    leave_unstable();
  }
  return true;
}

// Stability changes on the way to this load factor: closer, until the step is the finest; then it is told.
void HeldSteps::lose(double target, int after) {
  const double here = current_.point.state.load_factor;
  const int before = current_.point.stability.negative;
  if (halvings_ < finest) return halve(target, "stability changes");
  note(fmt::format("between load factors {:.10g} and {:.10g} the number of negative eigenvalues goes from {} to {}: a branch point or a "
                   "limit point, not located further", here, target, before, after));
  current_.point.stability.negative = after;
  if (after > before) leave_unstable();
}

void HeldSteps::leave_unstable() {
  if (options_.when_unstable == WhenUnstable::stop)
    return end(Status::converged, fmt::format("stopped where stability is lost, load factor {:.10g}", current_.point.state.load_factor));
  if (options_.when_unstable == WhenUnstable::jump && interval_ < targets_.size()) fall(targets_[interval_], "stability is lost");
}

void HeldSteps::halve(double target, const std::string& why) {
  if (interrupted()) return end(Status::interrupted, "interrupted");
  if (halvings_++ < finest) return;
  const double here = current_.point.state.load_factor;
  note(fmt::format("load factor {:.10g} could not be passed in steps of {:.3g}: {}", here, std::abs(target - here), why));
  if (options_.when_unstable == WhenUnstable::stop)
    return end(Status::not_converged, fmt::format("the branch ends at load factor {:.10g}: {}", here, why));
  fall(targets_[interval_], why);
}

// A little farther on, the minimum that Ipopt finds from here.
void HeldSteps::fall(double target, const std::string& why) {
  Energy& energy = newton_.energy();
  const double here = current_.point.state.load_factor, past = here + beyond_event * (target - here);
  if (std::abs(past - here) <= 1e-9 * std::abs(options_.to - options_.from))
    return end(Status::not_converged, fmt::format("the branch ends at load factor {:.10g}: {}", here, why));
  State state = current_.point.state;
  energy.kinematics().prescribe(state, past);
  if (energy.passage(current_.point.state, state) < 1)
    return end(Status::not_converged, fmt::format("the branch ends at load factor {:.10g}: {}", here, why));
  if (current_.tangent.allFinite()) {
    State predicted = state;
    energy.kinematics().retract(predicted, current_.tangent, past - here);
    if (energy.passage(current_.point.state, predicted) == 1 && movement(energy, current_.tangent) * std::abs(past - here) < 1) state = predicted;
  }
  energy.evaluate(state, false);
  const double before = energy.last_terms().total();
  const Report report = minimise(newton_, state, IpoptOptions{.tolerance = newton_.tolerance()});
  if (!report.converged())
    return end(report.status, fmt::format("the branch ends at load factor {:.10g}; Ipopt finds no minimum beyond: {}", here, report.why));
  Equilibrium landed = assess(newton_, state, report);
  halvings_ = changes_ = 0;
  const std::string what = fmt::format("from energy {:.10g} to {:.10g} at load factor {:.10g}", before, report.energy, past);
  if (same_branch(energy, current_, landed)) {
    tell(landed.point);                                         // only the steps were too hard
  } else {
    note(fmt::format("jump: {}", what));
    emit_landing(landed.point, what, current_.point.stability.negative, "");
  }
  closed_ = state.hard;
  accept(std::move(landed), past);
}

}  // namespace elamin
