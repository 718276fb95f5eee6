#include "path/load_steps.hpp"

#include "core/interrupt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr int finest = 20;                          // halvings of a step
constexpr int seek_limit = 8, seek_again = 6;       // halvings after which a limit point is looked for, and every so many more
constexpr std::int64_t whole = std::int64_t(1) << finest;
constexpr double beyond_event = 0.1;                // of the way to the next step: where a jump is made

// Load factors to hit, in order: the even steps and the stops asked for.
std::vector<double> targets_of(const PathOptions& o) {
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

}  // namespace

LoadSteps::LoadSteps(Newton& newton, const State& start, PathOptions options)
    : newton_(newton), options_(std::move(options)), start_(start), targets_(targets_of(options_)),
      interval_start_(options_.start.value_or(options_.from)) {}

std::optional<PathPoint> LoadSteps::next() {
  while (ready_.empty() && !ended_) {
    if (!begun_) begun_ = begin();
    else step();
  }
  if (ready_.empty()) return {};
  PathPoint point = std::move(ready_.front());
  ready_.pop_front();
  return point;
}

bool LoadSteps::end(Status status, std::string why) {
  ended_ = true, status_ = status, why_ = std::move(why);
  return false;
}

void LoadSteps::emit(PathPoint point) {
  point.step = steps_++;
  point.branch = branch_;
  ready_.push_back(std::move(point));
}

void LoadSteps::emit(Event& event) {
  PathPoint& point = event.at.point;
  point.label = event.kind == EventKind::limit ? fmt::format("limit:{}", ++limit_points_) : fmt::format("branch:{}", ++branch_points_);
  emit(point);
}

// The first equilibrium: at `from`, from the given state; the minimum if the stationary point nearby is not stable.
bool LoadSteps::begin() {
  State state = start_;
  newton_.energy().kinematics().prescribe(state, interval_start_);
  Report report = newton_.correct(state);
  if (report.converged()) current_ = assess(newton_, state, report);
  if (!report.converged() || (current_.point.stability.negative > 0 && options_.when_unstable == WhenUnstable::jump)) {
    if (report.converged()) {
      notes_.push_back(fmt::format("the starting state is unstable ({} negative eigenvalues); it falls to a minimum",
                                   current_.point.stability.negative));
    } else {
      state = start_;
      newton_.energy().kinematics().prescribe(state, interval_start_);
    }
    report = newton_.minimise(state);
    if (!report.converged()) {
      current_.point.state = state, current_.point.report = report;
      begun_ = true;
      return end(report.status, fmt::format("no equilibrium at the start, load factor {:.10g}: {}", interval_start_, report.why));
    }
    current_ = assess(newton_, state, report);
  }
  current_.point.label = "initial";
  closed_ = closed_contacts(newton_.energy(), current_.point.state);
  emit(current_.point);
  if (current_.point.stability.negative > 0 && options_.when_unstable == WhenUnstable::stop)
    end(Status::converged, "the starting state is unstable");
  return true;
}

bool LoadSteps::step() {
  if (interval_ == targets_.size()) return end(Status::converged, fmt::format("load factor {:.10g} reached", options_.to));
  if (interrupted()) return end(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", current_.point.state.load_factor));
  const std::int64_t part = whole >> halvings_;
  const std::int64_t arrived = done_ + part;
  const double goal = targets_[interval_];
  const double target = arrived == whole ? goal : interval_start_ + (goal - interval_start_) * (static_cast<double>(arrived) / whole);

  Equilibrium candidate = continue_to(newton_, current_, target);
  std::optional<Event> event;
  std::optional<ContactEvent> contact;
  bool accepted = candidate.point.report.converged();
  if (accepted && options_.contacts && (contact = locate_contact(newton_, closed_, current_, candidate))) {
    if (contact->found) candidate = contact->at;
    else accepted = halvings_ == finest, contact.reset();       // shorter steps, as long as there are
  }
  if (accepted && candidate.point.stability.negative != current_.point.stability.negative) {
    event = locate_crossing(newton_, current_, candidate);
    accepted = event.has_value();
  }
  if (!accepted) {
    if (candidate.point.report.status == Status::interrupted) return end(Status::interrupted, "interrupted");
    if (halvings_ >= seek_limit && (halvings_ - seek_limit) % seek_again == 0) {
      if (std::optional<Event> limit = locate_limit(newton_, current_, target)) return lose_stability(*limit, goal);
    }
    if (halvings_ == finest && options_.when_unstable == WhenUnstable::jump && fall(target)) return true;
    if (halvings_ == finest)
      return end(Status::not_converged, fmt::format("load factor {:.10g} could not be passed even in steps of {:.3g}: {}",
          current_.point.state.load_factor, std::abs(target - current_.point.state.load_factor), candidate.point.report.why));
    ++halvings_;
    return true;
  }
  if (event) return lose_stability(*event, target);
  if (contact) return meet(std::move(*contact));

  current_ = std::move(candidate);
  closed_ = closed_contacts(newton_.energy(), current_.point.state);
  done_ = arrived;
  if (done_ == whole) ++interval_, interval_start_ = goal, done_ = 0;
  if (halvings_ > 0 && done_ % (2 * part) == 0) --halvings_;
  emit(current_.point);
  return true;
}

// A contact made or lost: a point of the path, which goes on from there.
bool LoadSteps::meet(ContactEvent event) {
  current_ = std::move(event.at);
  closed_ = std::move(event.after);
  current_.point.label = fmt::format("contact:{}", ++contact_events_);
  interval_start_ = current_.point.state.load_factor, done_ = 0;
  if (interval_start_ == targets_[interval_]) ++interval_;
  emit(current_.point);
  current_.point.label.clear();
  return true;
}

// What comes after an event: the end, the other side of the same branch, or a fall.
bool LoadSteps::lose_stability(const Event& located, double target) {
  Event event = located;
  emit(event);
  const double at = event.at.point.state.load_factor;
  const std::string& label = event.at.point.label;
  if (options_.when_unstable == WhenUnstable::stop)
    return end(Status::converged, fmt::format("stopped at {}, load factor {:.10g}", label, at));
  if (options_.when_unstable == WhenUnstable::jump) return jump(event, target);
  if (event.kind == EventKind::limit)
    return end(Status::not_converged,
               fmt::format("{} at load factor {:.10g}: load steps cannot follow the branch beyond; use the arc-length method",
                           label, at));
  // Over the event along the tangent: the critical modes keep still, so that the branch is not left.
  Equilibrium start = event.at;
  start.zero_modes = event.modes;
  start.tangent -= event.modes * (event.modes.transpose() * start.tangent);
  const double past = at + std::min(beyond_event, 1.0) * (target - at);
  Equilibrium next = continue_to(newton_, start, past);
  if (!next.point.report.converged())
    return end(Status::not_converged, fmt::format("the branch is lost behind {}, load factor {:.10g}: {}", label, at, next.point.report.why));
  next.zero_modes = current_.zero_modes;
  current_ = next;
  closed_ = closed_contacts(newton_.energy(), current_.point.state);
  interval_start_ = past, done_ = 0;
  return true;
}

// Where the branch ends within the finest step, at an event that could not be resolved: the minimum that is reached by going
// down from there, beyond.
bool LoadSteps::fall(double target) {
  State state = current_.point.state;
  const double at = state.load_factor, before = newton_.energy().value(state);
  newton_.energy().kinematics().prescribe(state, target);
  if (newton_.energy().passage(current_.point.state, state) < 1) return false;
  const Report report = newton_.minimise(state, Pace::downhill);
  if (!report.converged()) return false;
  current_ = assess(newton_, state, report);
  closed_ = closed_contacts(newton_.energy(), state);
  ++branch_;
  notes_.push_back(fmt::format("the branch ends at load factor {:.10g} in an event that could not be located: fall from energy {:.10g} to {:.10g}",
                               at, before, report.energy));
  interval_start_ = target, done_ = 0;
  if (target == targets_[interval_]) ++interval_;
  emit(current_.point);
  return true;
}

// Just past the event the branch has turned unstable or ended: the state falls along the critical mode, to the minimum
// that is reached by going down from there.
bool LoadSteps::jump(const Event& event, double target) {
  const double at = event.at.point.state.load_factor, past = at + beyond_event * (target - at);
  State state = event.at.point.state;
  newton_.energy().kinematics().prescribe(state, past);
  newton_.energy().kinematics().retract(state, event.at.tangent, event.kind == EventKind::branch ? past - at : 0.0);
  State jumped_from = state;
  if (event.kind == EventKind::branch) {
    const Report report = newton_.correct(state, event.modes, &event.at.point.state);   // the unstable equilibrium beyond
    jumped_from = state;
    if (report.converged() && !newton_.leave_saddle(state, event.modes.col(0)))
      notes_.push_back(fmt::format("{}: no lower energy along the critical mode just beyond", event.at.point.label));
  }
  newton_.energy().evaluate(jumped_from);
  const double before = newton_.energy().last_terms().total();
  Report report = newton_.minimise(state, Pace::downhill);
  if (report.status == Status::not_converged) report = newton_.minimise(state);
  if (!report.converged()) {
    current_.point.state = state, current_.point.report = report;
    return end(report.status, fmt::format("no minimum was found after {} at load factor {:.10g}: {}", event.at.point.label, at, report.why));
  }
  current_ = assess(newton_, state, report);
  closed_ = closed_contacts(newton_.energy(), state);
  ++branch_;
  notes_.push_back(fmt::format("jump at {}: load factor {:.10g}, energy {:.10g} to {:.10g} after {} iterations",
                               event.at.point.label, at, before, report.energy, report.iterations));
  interval_start_ = past, done_ = 0;
  emit(current_.point);
  return true;
}

}  // namespace elamin
