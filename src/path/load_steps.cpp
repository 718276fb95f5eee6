#include "path/load_steps.hpp"

#include "core/interrupt.hpp"
#include "path/arc_length.hpp"
#include "path/cause.hpp"
#include "path/jump.hpp"
#include "path/locate.hpp"
#include "path/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr int finest = 20;                          // halvings of a step
constexpr int explore_first = 3, explore_again = 6; // halvings after which the branch is explored in arc length, and every so many more
constexpr int most_explored = 400;                  // steps in arc length then
constexpr std::int64_t whole = std::int64_t(1) << finest;
constexpr double beyond_event = 0.1;                // of the way to the next step: where a branch point is passed
constexpr double same_load = 1e-13;                 // of the range: load factors that are one
constexpr double fall_beyond = 1e-3;                // of the range of load factors: where a fall begins

}  // namespace

std::vector<double> load_targets(const PathOptions& o) {
  std::vector<double> targets;
  const double sign = o.to > o.from ? 1 : -1, start = o.start.value_or(o.from);
  const double same = 1e-12 * std::max(std::abs(o.from), std::abs(o.to));
  const auto add = [&](double t) {
    if (sign * (t - start) > same && sign * (o.to - t) >= 0) targets.push_back(t);
  };
  for (int k = 1; k <= o.steps; ++k) add(k == o.steps ? o.to : o.from + (o.to - o.from) * k / o.steps);
  for (const double s : o.stops) add(s);
  std::sort(targets.begin(), targets.end(), [&](double a, double b) { return sign * a < sign * b; });
  targets.erase(std::unique(targets.begin(), targets.end(), [&](double a, double b) { return std::abs(a - b) <= same; }), targets.end());
  return targets;
}

LoadSteps::LoadSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), options_(std::move(options)), start_(start), targets_(load_targets(options_)),
      interval_start_(options_.start.value_or(options_.from)) {}

void LoadSteps::advance() {
  if (!begun_) begin();
  else step();
}

void LoadSteps::begin() {
  begun_ = true;
  std::string sentence;
  Equilibrium first = first_equilibrium(newton_, start_, interval_start_, options_.when_unstable, options_.resume.has_value(), sentence);
  if (!sentence.empty()) note(sentence);
  if (!first.point.report.converged()) return end(first.point.report.status, first.point.report.why);
  first.point.label = "initial";
  emit(first.point);
  first.point.label.clear();
  settle(first, interval_start_);
  if (options_.resume) {
    closed_ = resumed_contacts(*options_.resume);
    if (options_.resume->tangent.size() == current_.tangent.size()) current_.tangent = options_.resume->tangent;
    for (std::size_t k = 0; k < side_.size(); ++k)
      if (options_.resume->label.starts_with(options_.watches[k].name + ":")) side_[k] = 0;      // not known yet
    if (std::optional<Event> event = resumed_event(*options_.resume, first)) {
      told_already_ = true;
      return lose_stability(std::move(*event), targets_.empty() ? options_.to : targets_[interval_]);
    }
  }
  if (negative_ > 0 && options_.when_unstable == WhenUnstable::stop) end(Status::converged, "the starting state is unstable");
}

// Goes on from here; the interval's halving counts from this load factor.
void LoadSteps::settle(Equilibrium at, double load_factor, const std::vector<Event>& passed) {
  current_ = std::move(at);
  current_.point.label.clear();
  negative_ = current_.point.stability.negative;
  closed_ = closed_contacts(newton_.energy(), current_.point.state);
  side_.resize(options_.watches.size(), 0);
  pass_watches(options_.watches, passed, current_.point.state, side_);
  interval_start_ = load_factor, done_ = 0;
  if (interval_ < targets_.size() && load_factor == targets_[interval_]) ++interval_;
}

void LoadSteps::step() {
  const double here = current_.point.state.load_factor;
  if (interval_ == targets_.size()) return end(Status::converged, fmt::format("load factor {:.10g} reached", options_.to));
  if (interrupted()) return end(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", here));
  const std::int64_t part = whole >> halvings_;
  const std::int64_t arrived = done_ + part;
  const double goal = targets_[interval_];
  const double target = arrived == whole ? goal : interval_start_ + (goal - interval_start_) * (static_cast<double>(arrived) / whole);

  Equilibrium candidate = continue_to(newton_, current_, target, options_.correct);
  const auto between = [&, end = candidate.point.state](double t, const Equilibrium& nearest) {
    Equilibrium e = continue_to(newton_, nearest, t);
    if (e.point.report.converged() && !beside_chord(newton_.energy().kinematics(), current_.point.state, end, e.point.state))
      e.point.report.status = Status::not_converged, e.point.report.why = "the corrector went to another branch";
    return e;
  };
  Segment segment = segment_of_loads(newton_, here, target);
  segment.at = between;
  std::optional<Event> event;
  std::optional<ContactChange> contact;
  bool accepted = candidate.point.report.converged();
  if (accepted && options_.contacts && (contact = locate_contact(newton_, segment, closed_, current_, candidate))) {
    accepted = contact->found && same_branch(newton_.energy(), current_, contact->at);
    if (accepted) candidate = contact->at, segment.b = contact->at_parameter;
  }
  if (accepted && candidate.point.stability.negative != negative_) {
    event = locate_crossing(newton_, segment, current_, negative_, candidate, {});
    accepted = event && event->kind == EventKind::branch && leads_to(newton_, event->at, candidate) && leads_to(newton_, event->at, current_);
  }
  if (!accepted) {
    if (candidate.point.report.status == Status::interrupted) return end(Status::interrupted, "interrupted");
    if (halvings_ >= explore_first && (halvings_ - explore_first) % explore_again == 0 && explore(target)) return;
    if (halvings_ < finest) {
      ++halvings_;
      return;
    }
    if (options_.when_unstable == WhenUnstable::jump && fall(target)) return;
    std::string why = candidate.point.report.converged() ? "an event could not be located" : candidate.point.report.why;
    if (const std::string cause = cause_at(newton_, current_); !cause.empty()) why += "; " + cause;
    return end(Status::not_converged, fmt::format("load factor {:.10g} could not be passed even in steps of {:.3g}: {}", here,
                                                  std::abs(target - here), why));
  }
  if (event) segment.b = event->at_parameter, candidate = event->at;
  bool missed = false;
  std::vector<Event> seen = locate_watches(options_.watches, side_, segment, current_, candidate, negative_, missed);
  if (missed && halvings_ < finest) {
    ++halvings_;
    return;
  }
  const bool together = !seen.empty() && std::abs(segment.b - seen.front().at_parameter) <= coincide * std::abs(segment.b - segment.a);
  if (!seen.empty() && !(together && (event || contact))) return reach(std::move(seen));
  for (Event& e : seen) emit(e);
  pass_watches(options_.watches, seen, candidate.point.state, side_);
  if (event) return lose_stability(std::move(*event), goal);
  if (contact) return meet(std::move(*contact), goal);

  const std::int64_t done = arrived;
  const double start = interval_start_;
  emit(candidate.point);
  settle(std::move(candidate), start);
  done_ = done;
  if (done_ == whole) ++interval_, interval_start_ = goal, done_ = 0;
  if (halvings_ > 0 && done_ % (2 * part) == 0) --halvings_;
}

void LoadSteps::reach(std::vector<Event> events) {
  halvings_ = 0;
  Equilibrium at = events.front().at;
  const double here = at.point.state.load_factor;
  for (Event& event : events) {
    event.closed = closed_contacts(newton_.energy(), event.at.point.state);
    emit(event);
  }
  settle(std::move(at), here, events);
  for (const Event& event : events)
    if (options_.watches[event.watch].stop) return end(Status::converged, fmt::format("{} reached at load factor {:.10g}", event.what, here));
}

// A contact made or lost: a point of the path, which goes on from there.
void LoadSteps::meet(ContactChange change, double target) {
  Event event;
  event.kind = EventKind::contact, event.what = change.what;
  event.at = std::move(change.at);
  event.before = event.after = negative_;
  event.closed = change.after;
  const double here = event.at.point.state.load_factor;
  if (change.beyond) {
    event.after = change.beyond->point.stability.negative;
    if (change.onward * (options_.to - options_.from) < 0) event.kind = EventKind::limit;
  }
  if (event.kind == EventKind::limit) return lose_stability(std::move(event), target);
  halvings_ = 0;
  emit(event);
  Equilibrium on = change.beyond ? std::move(*change.beyond) : event.at;
  on.point.label.clear();
  settle(std::move(on), here);
  closed_ = std::move(change.after);
  const double beyond = interval_ < targets_.size() ? (here - targets_[interval_]) / (options_.to - options_.from) : -1;
  if (beyond >= 0 && beyond <= same_load) ++interval_;          // the event lies a rounding beyond the end of the step
  if (event.before > 0 || event.after == 0) return;
  if (options_.when_unstable == WhenUnstable::stop) return end(Status::converged, fmt::format("stopped at {}, load factor {:.10g}", event.at.point.label, here));
  if (options_.when_unstable == WhenUnstable::jump) jump(event, target);
}

// What stops the steps, told by following the branch in arc length: an event that load steps cannot meet themselves, or an
// equilibrium beyond. False if nothing came of it.
bool LoadSteps::explore(double target) {
  const double here = current_.point.state.load_factor, way = target - here;
  PathOptions local = options_;
  local.from = here, local.to = target, local.steps = 4;
  const Metric metric = metric_for(newton_.energy(), current_, local);
  WalkOptions w;
  w.load_step = std::abs(way), w.turn = 0.1, w.contacts = options_.contacts;
  w.stops = {target, here - 100 * way};
  w.watches = options_.watches, w.sides = side_;
  const Direction towards{Vector::Zero(current_.tangent.size()), way > 0 ? metric.load : -metric.load};
  Walk walk(newton_, current_, direction_of(current_, metric, towards), negative_, closed_, metric, w);
  for (int k = 0; k < most_explored; ++k) {
    std::optional<Waypoint> next = walk.next();
    if (!next) return false;
    const double load = next->at.point.state.load_factor;
    if (!next->events.empty()) {
      Event& event = next->events.front();
      if (event.kind == EventKind::watch) {
        reach(std::move(next->events));
        return true;
      }
      for (std::size_t j = 1; j < next->events.size(); ++j) emit(next->events[j]);
      pass_watches(options_.watches, next->events, event.at.point.state, side_);
      if (event.kind == EventKind::contact) {
        meet({true, 0, event.at, event.closed, event.what, event.beyond, event.onward}, targets_[interval_]);
        return true;
      }
      if (event.kind == EventKind::limit && event.before > 0 && options_.when_unstable != WhenUnstable::follow) return false;
      lose_stability(std::move(event), targets_[interval_]);
      return true;
    }
    if (next->stop && load != target) return false;
    const bool beyond = (load - target) * way >= 0;
    emit(next->at.point);
    settle(std::move(next->at), load);
    halvings_ = std::max(0, halvings_ - 1);
    if (beyond) return true;
  }
  return false;
}

// What comes after an event: the end, the other side of the same branch, or a fall.
void LoadSteps::lose_stability(Event event, double target) {
  halvings_ = 0;                                                // as where a path is taken up
  const bool told = std::exchange(told_already_, false);
  if (!told && ((event.kind == EventKind::limit && options_.limits) || (event.kind == EventKind::branch && options_.branch_points))) {
    event.closed = closed_;
    emit(event);
  }
  const double at = event.at.point.state.load_factor;
  const std::string label = event.at.point.label.empty() ? "the loss of stability" : event.at.point.label;
  const bool loses = event.after > event.before;
  if (loses && options_.when_unstable == WhenUnstable::stop) return end(Status::converged, fmt::format("stopped at {}, load factor {:.10g}", label, at));
  if (event.kind == EventKind::limit) {
    if (options_.when_unstable == WhenUnstable::jump) return jump(event, target);
    return end(Status::not_converged,
               fmt::format("{} at load factor {:.10g}: load steps cannot follow the branch beyond; use path.method = \"arc_length\"", label, at));
  }
  if (loses && options_.when_unstable == WhenUnstable::jump) return jump(event, target);
  pass(event, target);
}

// Over a branch point along the tangent: to where the Morse index is the one beyond, with the critical modes free, or held where that
// leads to another branch.
void LoadSteps::pass(const Event& event, double target) {
  const double at = event.at.point.state.load_factor;
  Equilibrium free = event.at, held = event.at;
  held.zero_modes = side_by_side(held.zero_modes, event.modes);
  Equilibrium next;
  for (double part = beyond_event; part > 1e-6; part /= 4) {
    const double past = at + part * (target - at);
    for (const Equilibrium* start : {&free, &held}) {
      next = continue_to(newton_, *start, past);
      if (!next.point.report.converged() || next.point.stability.negative != event.after) continue;
      if (next.zero_modes.cols() == held.zero_modes.cols()) next.zero_modes = free.zero_modes;
      return settle(std::move(next), past);
    }
  }
  end(Status::not_converged, fmt::format("the branch is lost behind {}, load factor {:.10g}: {}", event.at.point.label, at, next.point.report.why));
}

// Where the branch ends within the finest step, at an event that could not be resolved: the minimum that is reached by going
// down from there, beyond.
bool LoadSteps::fall(double target) {
  State state = current_.point.state;
  const double at = state.load_factor, before = newton_.energy().value(state);
  newton_.energy().kinematics().prescribe(state, target);
  if (newton_.energy().passage(current_.point.state, state) < 1) return false;
  const Report report = newton_.minimise(state, Pace::downhill);
  if (!report.converged() || !(report.energy < before)) return false;
  note(fmt::format("the branch ends at load factor {:.10g} in an event that could not be located: fall from energy {:.10g} to {:.10g}",
                   at, before, report.energy));
  Equilibrium landed = assess(newton_, state, report);
  emit_landing(landed.point, fmt::format("from energy {:.10g} to {:.10g} at load factor {:.10g}", before, report.energy, target), negative_, "");
  settle(std::move(landed), target);
  return true;
}

// Just past the event the branch has turned unstable or ended: the state falls to the minimum below.
void LoadSteps::jump(const Event& event, double target) {
  const double at = event.at.point.state.load_factor;
  const double range = options_.to - options_.from;
  double next = target;                                         // ahead, where the event is at a target
  for (const double t : targets_)
    if ((t - at) / range > same_load) {
      next = t;
      break;
    }
  const double past = at + std::copysign(std::min(fall_beyond * std::abs(range), std::abs(next - at) / 2), range);
  std::string what;
  Equilibrium landed = jump_from(newton_, event, past, what);
  note(fmt::format("jump at {}: {}", event.at.point.label, what));
  if (!landed.point.report.converged()) return end(landed.point.report.status, landed.point.report.why);
  emit_landing(landed.point, what, event.before, event.at.point.label);
  settle(std::move(landed), past);
}

}  // namespace elamin
