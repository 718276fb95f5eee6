#include "path/walk.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace elamin {

namespace {

constexpr double largest_angle = 0.7;         // between the directions at both ends of a step [rad]
constexpr double wanted_angle = 0.25;
constexpr int wanted_iterations = 4;
constexpr double largest_departure = 0.5;     // of the corrector, in parts of the step
constexpr double largest_defect = 0.2;        // of the chord from the sum of the tangents, in parts of the chord
constexpr double least_part = 1e-12;          // of the first step: shorter ones are given up
constexpr double just_beyond = 0.125;         // of a first step from a branch point: where the Morse index is looked at, too
constexpr double same_end = 1e-3;             // of the way: an event leads there
constexpr double first_over = 0.01, least_over = 1e-9;   // of a load step: beyond a contact that makes a corner
constexpr double same_mode = 0.9;             // cosine between a neutral mode and what it has become a step further
constexpr double next_to_nothing = 1e-6;      // of the next stiffness
constexpr int most_shifts = 5;                // of a step that ends on an event by chance
constexpr int halvings_at_first = 8;          // then steps are quartered

int sign_of(double x) { return x < 0 ? -1 : 1; }

// The direction of a side branch where it arrives at a branch point.
Direction passing(const Event& arrival, const Metric& metric) {
  const double size = std::sqrt(metric.dot(arrival.passing, arrival.passing_load, arrival.passing, arrival.passing_load));
  return {arrival.passing / size, arrival.passing_load / size};
}

// Zero modes that last along a branch and are no motions of rigid parts.
void name_neutral(Stability& s) {
  s.zero_modes.push_back(fmt::format("neutral: equilibria side by side at the same load factor ({} direction{})", s.critical, s.critical > 1 ? "s" : ""));
  s.critical = 0;
  s.stable = s.negative == 0;
}

// Of zero modes those along which no force acts at the last evaluation: what a force acts along is neutral no more.
Eigen::MatrixXd without_force(const Energy& energy, const Eigen::MatrixXd& zero) {
  const Vector along = zero.transpose() * energy.gradient();
  if (zero.cols() < 2 || along.norm() == 0) return Eigen::MatrixXd(zero.rows(), 0);
  return zero * complement(along);
}

}  // namespace

Walk::Walk(Newton& newton, Equilibrium start, Direction direction, int negative, ContactSet closed, Metric metric, WalkOptions options)
    : newton_(newton), metric_(metric), options_(std::move(options)), current_(std::move(start)), direction_(std::move(direction)),
      negative_(negative), sign_(sign_of(direction_.load)), closed_(std::move(closed)) {
  at_contact_ = options_.told.starts_with("contact:");
  singular_ = negative_ < 0 || options_.told.starts_with("limit:") || options_.told.starts_with("branch:");
  if (negative_ < 0) neutral_ = current_.zero_modes;
  side_ = options_.sides;
  for (std::size_t k = side_.size(); k < options_.watches.size(); ++k) {
    const Watch& w = options_.watches[k];
    side_.push_back(options_.told.starts_with(w.name + ":") ? 0 : w.side(current_.point.state));
  }
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
  int shifts = 0, refused = 0;
  step_ = std::min(step_, longest());
  const auto shorter = [&](double s) { return ++refused > halvings_at_first ? s / 4 : s / 2; };
  for (double s = step_; s >= shortest_ && !interrupted();) {
    const Arc arc(newton_, current_, direction_, metric_);
    std::optional<Candidate> c = reach(arc, s, why);
    const bool corner = !c && (c = reach_corner(arc, s)).has_value();
    if (!c && at_contact_ && (c = step_over_contact())) {
      Candidate over = std::move(*c);
      step_ = s;
      return accept(std::move(over), arc);
    }
    if (!c) {
      s = shorter(s);
      continue;
    }
    const double change = std::abs(c->e.point.state.load_factor - current_.point.state.load_factor);
    if (!corner && change > 1.5 * options_.load_step) {
      s *= std::clamp(0.9 * std::sqrt(options_.load_step / change), 0.1, 0.9);
      continue;
    }
    const bool ends_on_event = c->e.point.stability.critical > 0 && c->e.zero_modes.cols() > current_.zero_modes.cols();
    if (!corner && ends_on_event && shifts < most_shifts) {
      s *= 0.87, ++shifts;                                     // an event by chance: let it be inside of a step
      continue;
    }
    if (negative_ < 0 && !look_beyond(arc, *c)) {
      s *= just_beyond;
      continue;
    }
    const auto between = [&, end = c->e.point.state](double t, const Equilibrium& nearest) {
      Equilibrium e = arc.at(t, nearest);
      if (e.point.report.converged() && !beside_chord(newton_.energy().kinematics(), current_.point.state, end, e.point.state))
        e.point.report.status = Status::not_converged, e.point.report.why = "the corrector went to another branch";
      return e;
    };
    const Segment segment{0, c->s, between, [&](State& state, const Eigen::MatrixXd& held) { return arc.settle(state, held); },
                          [&](const State& state) { return arc.position(state); }, [&](const Equilibrium& e) { return arc.load_rate(e); }};
    if ((!corner && !find_contact(segment, *c, why)) || !find_critical(segment, arc, *c, why) || !find_watches(segment, *c, why)) {
      s = shorter(s);
      continue;
    }
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
  if (!e.point.report.converged() && neutral_.cols() > 0) {
    Equilibrium from = current_;
    from.zero_modes = without_force(newton_.energy(), from.zero_modes);
    e = arc.at(s, from);
  }
  if (!e.point.report.converged()) return why = e.point.report.why, std::nullopt;
  if (!stays_on_branch(arc, s, e, why)) return {};
  carry_neutral(e);
  return Candidate{s, std::move(e), {}, {}};
}

bool Walk::stays_on_branch(const Arc& arc, double s, const Equilibrium& e, std::string& why) const {
  if (arc.distance(e.point.state) > largest_departure * s) return why = "the corrector moved further than the predictor", false;
  const Direction d = direction_of(e, metric_, direction_);
  if (cosine(d, direction_, metric_) < std::cos(largest_angle)) return why = "the branch turns too sharply", false;
  const Vector x = newton_.energy().kinematics().difference(current_.point.state, e.point.state), mean = d.x + direction_.x;
  const double load = e.point.state.load_factor - current_.point.state.load_factor, mean_load = d.load + direction_.load;
  const double part = metric_.dot(x, load, mean, mean_load) / metric_.dot(mean, mean_load, mean, mean_load);
  const Vector off = x - part * mean;
  const double off_load = load - part * mean_load;
  if (std::sqrt(metric_.dot(off, off_load, off, off_load)) > largest_defect * std::sqrt(metric_.dot(x, load, x, load)))
    return why = "the branch bends too sharply, or there is another one beside it", false;
  return true;
}

// Of a branch that leaves a branch point: whether the index is the same right behind it as at the candidate.
bool Walk::look_beyond(const Arc& arc, const Candidate& c) {
  const Equilibrium near = arc.at(just_beyond * c.s, current_);
  if (!near.point.report.converged()) return false;
  const auto rises = [&](const Equilibrium& e) { return direction_of(e, metric_, direction_).load >= 0; };
  if (near.point.stability.negative != c.e.point.stability.negative || rises(near) != rises(c.e)) return false;
  negative_ = near.point.stability.negative, sign_ = rises(near) ? 1 : -1;
  return true;
}

// A family of equilibria may cost a little to move along, as a polygon's does that stands for a ring: it stays neutral, and held, as long
// as that is next to nothing beside the next stiffness.
void Walk::carry_neutral(Equilibrium& e) {
  Stability& s = e.point.stability;
  if (neutral_.cols() == 0 || e.zero_modes.cols() >= neutral_.cols()) return;
  newton_.energy().evaluate(e.point.state);
  const EigenPairs pairs = newton_.factors().lowest(s.negative + static_cast<int>(neutral_.cols()) + 1);
  const Eigen::Index count = pairs.values.size();
  for (Eigen::Index j = 0; j < count; ++j) {
    const Vector& v = pairs.vectors.col(j);
    if ((neutral_.transpose() * v).norm() < same_mode) continue;
    if (e.zero_modes.cols() > 0 && (e.zero_modes.transpose() * v).norm() > 0.5) continue;      // it is one already
    double next = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < count; ++i)
      if (i != j) next = std::min(next, std::abs(pairs.values[i]));
    if (!(std::abs(pairs.values[j]) <= next_to_nothing * next) || !std::isfinite(next)) continue;
    e.zero_modes = side_by_side(e.zero_modes, v);
    ++s.zero, ++s.critical;
    s.stable = false;
    if (pairs.values[j] < 0) --s.negative, s.negative_rigid = std::min(s.negative_rigid, s.negative);
  }
}

// Beyond a contact that has just changed, in the direction in which the load factor was going; nothing happens in between.
std::optional<Walk::Candidate> Walk::step_over_contact() {
  at_contact_ = false;                                          // one try
  const double here = current_.point.state.load_factor;
  for (double part = first_over; part >= least_over; part /= 10) {
    Equilibrium e = continue_to(newton_, current_, here + sign_ * part * options_.load_step);
    if (!e.point.report.converged() || e.point.stability.negative != negative_ || e.point.stability.critical > 0) continue;
    if (closed_contacts(newton_.energy(), e.point.state) != closed_) continue;
    const auto passes = [&](std::size_t k) { return side_[k] * options_.watches[k].side(e.point.state) < 0; };
    bool any = false;
    for (std::size_t k = 0; k < side_.size(); ++k) any = any || passes(k);
    if (!any) return Candidate{0, std::move(e), {}, {}, true};
  }
  return {};
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
  event.at_parameter = c.s;
  c.e = std::move(change.at);
  event.at = c.e;
  c.events = {std::move(event)};
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
    if (c.events.empty()) return true;
    Event& contact = c.events.front();
    contact.after = contact.beyond ? contact.beyond->point.stability.negative : after;
    if (contact.beyond && contact.onward == -sign_) contact.kind = EventKind::limit;
    return true;
  }
  // What was neutral to rounding, and held, turns out to have a sign: no event.
  const Eigen::Index resolved = current_.zero_modes.cols() - c.e.zero_modes.cols();
  if (!turns && c.events.empty() && neutral_.cols() > 0 && resolved > 0 && std::abs(after - negative_) <= resolved) return true;
  std::optional<Event> event;
  if (after != negative_) {
    event = locate_crossing(newton_, segment, current_, negative_, c.e, turns);
    // Where the load factor turns with one eigenvalue's sign the determinant keeps its own: one end is enough.
    const bool fold = event && event->kind == EventKind::limit;
    if (event && !joins(*event, c.e, arc) && (!fold || singular_ || !joins(*event, current_, arc))) event.reset();
    if (event && !fold && !singular_ && !joins(*event, current_, arc)) event.reset();
  } else if (sign_of(slope(current_)) == sign_) {
    event = locate_arrival(newton_, segment, current_, c.e, slope);
  }
  if (!event || event->modes.cols() == 0) return why = "the Morse index changes, but there is no limit point and no branch point between: two branches pass by each other", false;
  c.s = event->at_parameter, c.e = event->at;
  c.events = {std::move(*event)};
  return true;
}

// A step and its two parts meet: from the event the branch leads to an end of the segment.
bool Walk::joins(const Event& event, const Equilibrium& end, const Arc& arc) const {
  const Arc from(newton_, event.at, direction_of(event.at, metric_, arc.direction()), metric_);
  State state;
  if (!from.correct(state, from.position(end.point.state), event.at).converged()) return false;
  const Kinematics& kinematics = newton_.energy().kinematics();
  const auto apart = [&](const State& a, const State& b) {
    const Vector x = kinematics.difference(a, b);
    const double load = b.load_factor - a.load_factor;
    return std::sqrt(metric_.dot(x, load, x, load));
  };
  const double way = apart(event.at.point.state, end.point.state);
  return apart(state, end.point.state) <= same_end * std::max(way, same_end * std::abs(arc.position(end.point.state)));
}

bool Walk::find_watches(Segment segment, Candidate& c, std::string& why) {
  segment.b = c.s;
  bool missed = false;
  Equilibrium end = c.e;
  if (!c.events.empty() && c.events.front().arrival) {         // this branch, not the one that is met
    const Direction d = passing(c.events.front(), metric_);
    end.tangent = d.x / (std::abs(d.load) > 1e-100 ? d.load : 1e-100);
  }
  std::vector<Event> seen = locate_watches(options_.watches, side_, segment, current_, end, negative_, missed);
  if (missed) return why = "where an observable reaches its value could not be located", false;
  if (seen.empty()) return true;
  const bool before = seen.front().at_parameter < c.s - coincide * segment.b;
  if (before) c.s = seen.front().at_parameter, c.e = seen.front().at, c.events.clear();
  std::move(seen.begin(), seen.end(), std::back_inserter(c.events));
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
  const std::optional<Event> near = locate_root(segment, current_, c.e, [&](const Equilibrium& e) { return e.point.state.load_factor - *first; });
  Equilibrium e = at_load(near ? near->at : c.e, *first);
  if (!e.point.report.converged()) return;
  const double s = arc.position(e.point.state);
  if (s < 0 || s > c.s * (1 + 1e-6)) return;
  c.s = s, c.e = std::move(e), c.events.clear(), c.stop = first;
}

// The equilibrium at a load factor, from one that is near: as load steps find it, with what is neutral in its phase, or, where no step of the load
// factor can be told from rounding, as it is.
Equilibrium Walk::at_load(const Equilibrium& from, double load_factor) {
  const Kinematics& kinematics = newton_.energy().kinematics();
  if (neutral_.cols() == 0)
    if (Equilibrium e = continue_to(newton_, from, load_factor); e.point.report.converged()) return e;
  State state = from.point.state;
  const double change = load_factor - state.load_factor;
  kinematics.prescribe(state, load_factor);
  kinematics.retract(state, from.tangent, change);
  const Report report = correct_in_phase(newton_.energy(), from, state, [&](State& x, const Eigen::MatrixXd& held) { return newton_.correct(x, held); });
  if (report.converged()) {
    Equilibrium e = assess(newton_, state, report);
    carry_neutral(e);
    return e;
  }
  Equilibrium e = from;
  kinematics.prescribe(e.point.state, load_factor);
  newton_.energy().evaluate(e.point.state);
  if (newton_.energy().relative(newton_.energy().gradient()) > newton_.tolerance()) e.point.report.status = Status::not_converged;
  return e;
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
  const Event* event = c.events.empty() || c.events.front().kind == EventKind::watch ? nullptr : &c.events.front();
  const bool ordinary = c.events.empty() && !c.stop, corner = event && event->beyond.has_value();
  const bool critical = event && !corner && (event->kind == EventKind::limit || event->kind == EventKind::branch);
  neutral_ = !event && c.e.point.stability.critical > 0 ? c.e.zero_modes : Eigen::MatrixXd();
  if (neutral_.cols() > 0) name_neutral(c.e.point.stability);
  Direction next = direction_of(corner ? *event->beyond : c.e, metric_, arc.direction());
  if (corner && event->onward != 0 && sign_of(next.load) != event->onward) next.x = -next.x, next.load = -next.load;
  const int sign = sign_;
  last_stop_ = c.stop, taken_ = c.s;
  if (corner) {
    negative_ = event->after;
    sign_ = sign_of(next.load);
  } else if (critical) {
    if (event->arrival) next = passing(*event, metric_);        // on along the side branch, to its other half
    if (event->kind == EventKind::limit) sign_ = -sign_;
    if (event->arrival) sign_ = -sign_;
    if (event->arrival || event->kind == EventKind::limit) next.load = std::copysign(next.load, sign_);   // else rounding's
    negative_ = event->after;
  } else {
    negative_ = c.e.point.stability.negative;
    sign_ = sign_of(next.load);
  }
  singular_ = critical;
  closed_ = event && (corner || event->kind == EventKind::contact) ? event->closed : closed_contacts(newton_.energy(), c.e.point.state);
  pass_watches(options_.watches, c.events, c.e.point.state, side_);
  at_contact_ = event && event->kind == EventKind::contact;
  if (c.over) {                                                 // positions weigh as the load factor does from here on
    metric_.length = std::max(metric_.length, metric_.load * c.e.tangent.norm());
    next = direction_of(c.e, metric_, {Vector::Zero(next.x.size()), sign * metric_.load});
    sign_ = sign;
  } else if (ordinary) {                                        // the next step from how this one went
    const double angle = std::acos(std::clamp(cosine(next, direction_, metric_), -1.0, 1.0));
    const double ease = std::exp2((wanted_iterations - std::max(1, c.e.point.report.iterations)) / 2.0);
    step_ = c.s * std::clamp(std::min(ease, wanted_angle / std::max(angle, 1e-9)), 0.25, 2.0);
  }
  if (ordinary && !c.over) weigh(c.e, next);
  current_ = corner ? *event->beyond : c.e;
  if (corner) step_ = std::min(step_, longest());
  if (c.over) {
    direction_ = next;
    step_ = longest(), shortest_ = std::min(shortest_, least_part * step_);
  }
  current_.point.stability.critical = 0;                        // what is singular here has been told
  direction_ = std::move(next);
  return {std::move(c.e), std::move(c.events), c.stop};
}

}  // namespace elamin
