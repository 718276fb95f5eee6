#include "path/walk.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

namespace {

constexpr double largest_angle = 0.7;         // between the directions at both ends of a step [rad]
constexpr double wanted_angle = 0.25;
constexpr int wanted_iterations = 4;
constexpr double largest_departure = 0.5;     // of the corrector, in parts of the step
constexpr double least_part = 1e-8;           // of the first step: shorter ones are given up
constexpr int most_shifts = 5;                // of a step that ends on an event by chance

int sign_of(double x) { return x < 0 ? -1 : 1; }

}  // namespace

Walk::Walk(Newton& newton, Equilibrium start, Direction direction, int negative, ContactSet closed, Metric metric, WalkOptions options)
    : newton_(newton), metric_(metric), options_(std::move(options)), current_(std::move(start)), direction_(std::move(direction)),
      negative_(negative), sign_(sign_of(direction_.load)), closed_(std::move(closed)) {
  for (const Watch& w : options_.watches)
    side_.push_back(options_.told.starts_with(w.name + ":") ? 0 : w.side(current_.point.state));
  constexpr double least = 1e-6;                               // of the span
  least_length_ = std::min(metric_.length, least * span(newton.energy().model()));
  step_ = options_.step > 0 ? options_.step : longest();
  shortest_ = options_.shortest > 0 ? options_.shortest : least_part * step_;
}

// The step that neither the load factor nor the bonds forbid.
double Walk::longest() const {
  const double turn = distortion(newton_.energy(), current_.point.state, direction_.x, direction_.load);
  double most = std::numeric_limits<double>::infinity();
  if (direction_.load != 0) most = std::min(most, options_.load_step / std::abs(direction_.load));
  if (turn > 0) most = std::min(most, options_.turn / turn);
  return std::isfinite(most) ? most : 1.0;
}

std::optional<Waypoint> Walk::next() {
  std::string why = "the corrector does not converge";
  int shifts = 0;
  step_ = std::min(step_, longest());
  for (double s = step_; s >= shortest_ && !interrupted();) {
    const Arc arc(newton_, current_, direction_, metric_);
    std::optional<Candidate> c = reach(arc, s, why);
    const bool corner = !c && (c = reach_corner(arc, s)).has_value();
    if (!c) {
      s /= 2;
      continue;
    }
    if (!corner && c->e.point.stability.critical > 0 && current_.point.stability.critical == 0 && shifts < most_shifts) {
      s *= 0.87, ++shifts;                                     // an event by chance: let it be inside of a step
      continue;
    }
    Segment segment{0, c->s, [&arc](double t, const Equilibrium& nearest) { return arc.at(t, nearest); }};
    if ((!corner && !find_contact(segment, *c, why)) || !find_critical(segment, arc, *c, why)) {
      s /= 2;
      continue;
    }
    segment.b = c->s;
    if (std::optional<Event> seen = locate_watch(options_.watches, side_, segment, current_, c->e, negative_))
      c->s = seen->at_parameter, c->e = seen->at, c->event = std::move(seen);
    find_stop(segment, arc, *c);
    step_ = s;
    return accept(std::move(*c), arc);
  }
  status_ = interrupted() ? Status::interrupted : Status::not_converged;
  why_ = status_ == Status::interrupted
             ? fmt::format("interrupted at load factor {:.10g}", current_.point.state.load_factor)
             : fmt::format("the branch could not be followed beyond load factor {:.10g}, even in steps of {:.2g} of the first: {}",
                           current_.point.state.load_factor, least_part, why);
  return {};
}

// The equilibrium a step further, if it is on the same branch.
std::optional<Walk::Candidate> Walk::reach(const Arc& arc, double s, std::string& why) {
  Equilibrium e = arc.at(s, current_);
  if (!e.point.report.converged()) return why = e.point.report.why, std::nullopt;
  if (arc.distance(e.point.state) > largest_departure * s) return why = "the corrector moved further than the predictor", std::nullopt;
  const Direction d = direction_of(e, metric_, direction_);
  if (cosine(d, direction_, metric_) < std::cos(largest_angle)) return why = "the branch turns too sharply", std::nullopt;
  return Candidate{s, std::move(e), {}, {}};
}

// Or, where the branch may end or turn in a corner, the corner.
std::optional<Walk::Candidate> Walk::reach_corner(const Arc& arc, double s) {
  if (!options_.contacts) return {};
  std::optional<ContactChange> change = corner_ahead(newton_, closed_, current_, s * direction_.x, s * direction_.load);
  if (!change) return {};
  const double t = arc.position(change->at.point.state);
  constexpr double here = 1e-6;                                 // of the step: it may be where the walk stands
  if (!(t >= -here * s) || t > 1.5 * s || arc.distance(change->at.point.state) > std::max(largest_departure * t, here * s)) return {};
  return with_contact(Candidate{t, {}, {}, {}}, std::move(*change));
}

Walk::Candidate Walk::with_contact(Candidate c, ContactChange change) const {
  Event event;
  event.kind = EventKind::contact;
  event.before = negative_;                                     // after: when it is known that nothing comes before
  event.closed = std::move(change.after), event.what = std::move(change.what);
  event.beyond = std::move(change.beyond), event.onward = change.onward;
  c.e = std::move(change.at);
  event.at = c.e;
  c.event = std::move(event);
  return c;
}

bool Walk::find_contact(const Segment& segment, Candidate& c, std::string& why) {
  if (!options_.contacts) return true;
  std::optional<ContactChange> change = locate_contact(newton_, segment, closed_, current_, c.e);
  if (!change) return true;
  if (!change->found) return why = "a contact that is made or lost could not be located", false;
  c.s = change->at_parameter;
  c = with_contact(std::move(c), std::move(*change));
  return true;
}

// Branch points and limit points: where the Morse index changes, and where the load factor turns though it does not.
bool Walk::find_critical(Segment segment, const Arc& arc, Candidate& c, std::string& why) {
  segment.b = c.s;
  const int after = c.e.point.stability.negative;
  const auto slope = [&](const Equilibrium& e) { return direction_of(e, metric_, arc.direction()).load; };
  const bool turns = sign_of(slope(c.e)) != sign_;
  if (after == negative_ && !turns) {
    if (c.event) c.event->after = c.event->beyond ? c.event->beyond->point.stability.negative : after;
    if (c.event && c.event->beyond && c.event->onward == -sign_) c.event->kind = EventKind::limit;
    return true;
  }
  std::optional<Event> event;
  if (after != negative_) {
    event = locate_crossing(newton_, segment, current_, negative_, c.e);
  } else if (sign_of(slope(current_)) == sign_) {
    event = locate_arrival(newton_, segment, current_, c.e, slope, [&](const State& state) { return arc.position(state); });
  }
  if (!event || event->modes.cols() == 0) return why = "a change of stability could not be located", false;
  if ((event->kind == EventKind::limit) != turns && std::abs(after - negative_) <= event->modes.cols() && !event->arrival)
    return why = "what happens at a change of stability could not be told", false;
  c.s = event->at_parameter, c.e = event->at;
  c.event = std::move(event);
  return true;
}

// The first of the load factors to stop at, exactly there.
void Walk::find_stop(Segment segment, const Arc& arc, Candidate& c) {
  const double from = current_.point.state.load_factor, to = c.e.point.state.load_factor;
  std::optional<double> first;
  for (const double stop : options_.stops) {
    if (last_stop_ && stop == *last_stop_) continue;
    if ((from - stop) * (to - stop) > 0 || from == stop) continue;
    if (!first || std::abs(stop - from) < std::abs(*first - from)) first = stop;
  }
  if (!first) return;
  segment.b = c.s;
  std::optional<Event> near = locate_root(segment, current_, c.e, [&](const Equilibrium& e) { return e.point.state.load_factor - *first; });
  const Equilibrium& guess = near ? near->at : c.e;
  Equilibrium e = continue_to(newton_, guess, *first);
  if (!e.point.report.converged()) {
    if (!near) return;
    e = near->at;
  }
  const double s = arc.position(e.point.state);
  if (s < 0 || s > c.s * (1 + 1e-6)) return;
  c.s = s, c.e = std::move(e), c.event.reset(), c.stop = first;
}

// Positions must not weigh less than the load factor, or the steps would be load steps: L ≤ Λ |dx/dλ|.
void Walk::weigh(const Equilibrium& e, Direction& direction) {
  const double length = std::max(metric_.load * e.tangent.norm(), least_length_);
  if (length >= metric_.length) return;
  metric_.length = length;
  const double size = std::sqrt(cosine(direction, direction, metric_));
  direction.x /= size, direction.load /= size;
  step_ *= size, shortest_ *= size;
}

Waypoint Walk::accept(Candidate c, const Arc& arc) {
  const bool ordinary = !c.event && !c.stop, corner = c.event && c.event->beyond.has_value();
  Direction next = direction_of(corner ? *c.event->beyond : c.e, metric_, arc.direction());
  if (corner && c.event->onward != 0 && sign_of(next.load) != c.event->onward) next.x = -next.x, next.load = -next.load;
  last_stop_ = c.stop;
  if (corner) {
    negative_ = c.event->after;
    sign_ = sign_of(next.load);
  } else if (c.event && (c.event->kind == EventKind::limit || c.event->kind == EventKind::branch)) {
    if (c.event->arrival) next = arc.direction();               // on along the side branch, to its other half
    if (c.event->kind == EventKind::limit) sign_ = -sign_;
    if (c.event->arrival) sign_ = -sign_;
    if (c.event->arrival || c.event->kind == EventKind::limit) next.load = std::copysign(next.load, sign_);   // else rounding's
    negative_ = c.event->after;
  } else {
    negative_ = c.e.point.stability.negative;
    sign_ = sign_of(next.load);
  }
  closed_ = c.event && (corner || c.event->kind == EventKind::contact) ? c.event->closed : closed_contacts(newton_.energy(), c.e.point.state);
  for (std::size_t k = 0; k < side_.size(); ++k) {
    side_[k] = c.event && c.event->watch == static_cast<int>(k) ? -side_[k] : options_.watches[k].side(c.e.point.state);
  }
  if (ordinary) {                                               // the next step from how this one went
    const double angle = std::acos(std::clamp(cosine(next, direction_, metric_), -1.0, 1.0));
    const double ease = std::exp2((wanted_iterations - std::max(1, c.e.point.report.iterations)) / 2.0);
    step_ = c.s * std::clamp(std::min(ease, wanted_angle / std::max(angle, 1e-9)), 0.25, 2.0);
  }
  if (ordinary) weigh(c.e, next);
  current_ = c.e;
  if (corner) {
    current_ = *c.event->beyond;
    step_ = std::min(step_, longest());
  }
  current_.point.stability.critical = 0;                        // what is singular here has been told
  direction_ = std::move(next);
  if (c.event) c.event->at = c.e;
  return {std::move(c.e), std::move(c.event), c.stop};
}

}  // namespace elamin
