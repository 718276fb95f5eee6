#include "path/arc_steps.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/contact_event.hpp"
#include "path/fading_contact.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

using namespace limits;

namespace {

int sign_of(double x) { return x < 0 ? -1 : 1; }

// The direction of a side branch where it arrives at a branch point.
Direction passing(const Event& arrival, const Metric& metric) {
  const double size = std::sqrt(metric.dot(arrival.passing, arrival.passing_load, arrival.passing, arrival.passing_load));
  return {arrival.passing / size, arrival.passing_load / size};
}

// Of zero modes those along which no force acts at the last evaluation: what a force acts along is neutral no more.
Eigen::MatrixXd without_force(const Energy& energy, const Eigen::MatrixXd& zero) {
  const Vector along = zero.transpose() * energy.gradient();
  if (zero.cols() < 2 || along.norm() == 0) return Eigen::MatrixXd(zero.rows(), 0);
  return zero * complement(along);
}

}  // namespace

Metric metric_for(const Energy& energy, const Equilibrium& start, double load_range) {
  const double load = std::abs(load_range);
  const double least = arc_steps::least_length * span(energy.model()) * std::sqrt(std::max(1.0, static_cast<double>(energy.model().particles())));
  return {std::max(load * start.tangent.norm(), least), load};
}

ArcOptions arc_options(const PathOptions& o) {
  const double range = o.to - o.from;
  const double low = o.lowest.value_or(range > 0 ? o.from - 2 * range : o.to), high = o.highest.value_or(range > 0 ? o.to : o.from - 2 * range);
  ArcOptions a;
  a.load_step = std::abs(range) / o.steps;
  a.rotation = std::clamp(5.0 / o.steps, 1e-3, 0.2);
  a.contacts = o.contacts, a.event_errors = o.event_errors;
  a.stops = o.stops;
  for (const double end : {low, high, o.to}) a.stops.push_back(end);
  std::sort(a.stops.begin(), a.stops.end());
  a.stops.erase(std::unique(a.stops.begin(), a.stops.end()), a.stops.end());
  a.user_events = o.user_events;
  return a;
}

ArcSteps::ArcSteps(Newton& newton, Departure from, Direction direction, Metric metric, ArcOptions options)
    : Branch(newton, std::move(from), options.contacts, options.event_errors, options.user_events), metric_(metric), options_(std::move(options)),
      direction_(std::move(direction)) {
  sign_ = sign_of(direction_.load);
  tell_tangent();
  if (negative_ < 0 || current_.family > 0) neutral_ = current_.zero_modes;
  least_length_ = std::min(metric_.length, arc_steps::least_length * span(newton.energy().model()));
  step_ = options_.step > 0 ? options_.step : longest();
  shortest_ = options_.shortest > 0 ? options_.shortest : arc_steps::least_part * step_;
  for (const double stop : options_.stops)                      // where it begins it need not stop
    if (stands_at(current_, stop)) last_stop_ = stop;
}

void ArcSteps::carry(Archive& archive) {
  Branch::carry(archive);
  auto& [load_step, rotation, contacts, event_errors, stops, user_events, patience, step, shortest] = options_;     // the observables of user events come with the problem
  archive(load_step, rotation, contacts, event_errors, stops, patience, step, shortest, contacts_);
  archive(metric_, direction_, just_made_, last_stop_, step_, shortest_, least_length_, taken_, refused_);
}

// The step that neither the load factor nor the bonds forbid.
double ArcSteps::longest() const {
  const double rotation = distortion(newton_.energy(), current_.point.state, direction_.x, direction_.load);
  double most = std::numeric_limits<double>::infinity();
  if (direction_.load != 0) most = std::min(most, options_.load_step / std::abs(direction_.load));
  if (rotation > 0) most = std::min(most, options_.rotation / rotation);
  return std::isfinite(most) ? most : 1.0;
}

std::optional<Waypoint> ArcSteps::next() {
  std::string why = "the corrector does not converge";
  kink_refused_ = false;
  const bool meets = may_touch(newton_.energy().model());
  int refused = 0, shifts = 0;
  const bool loose = current_.slack || current_.pushed;         // where no contact bears a force there is no arc to measure
  double natural = loose ? 1 : arc_steps::first_natural;
  if (negative_ > 0 && !loose) natural = std::clamp(step_ * std::abs(direction_.load) / options_.load_step, arc_steps::least_bent, natural);
  std::optional<Direction> along;
  bool looked = false;
  if (neutral_.cols() == 1 && rest_in_family(newton_, current_)) {
    neutral_ = current_.zero_modes;
    direction_ = direction_of(current_, metric_, direction_);
  }
  step_ = std::min(step_, longest());
  const auto patient = [&] { return options_.patience == 0 || refused_ < options_.patience; };
  for (double s = step_; s >= shortest_ && patient() && !interrupted();) {
    double better = 0;
    std::optional<Candidate> c;
    if (!loose) c = attempt(s, direction_, false, shifts, better, why);
    if (!c && better == 0 && at_contact_ && !loose) {
      if (!looked) along = along_contact();
      looked = true;
      if (along && (c = attempt(s, *along, true, shifts, better, why))) direction_ = *along;
    }
    if (!c && better == 0 && meets && negative_ >= 0 && !singular_ && natural >= arc_steps::least_natural && (loose || at_contact_ || refused >= arc_steps::refused_first)) {
      const double target = next_load(natural);
      c = reach_load(current_, target, why);
      if (c && natural >= arc_steps::least_bent && over_bend(*c)) c.reset(), why = "the branch bends too much to be told from another one";
      if (c && c->events.empty() && std::binary_search(options_.stops.begin(), options_.stops.end(), target)) c->stop = target;
      natural /= 4;
    }
    if (c) {
      step_ = s;
      return accept(std::move(*c));
    }
    ++refused_;
    if (better > 0) s = better;
    else s /= ++refused > arc_steps::halvings_at_first ? 4 : 2;
  }
  const double here = current_.point.state.load_factor;
  if (interrupted()) stop_here(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", here));
  else stop_here(Status::not_converged, fmt::format("the branch could not be followed beyond load factor {:.10g}, even in steps of {:.2g} of the first: {}",
                                                    here, arc_steps::least_part, why));
  return {};
}

// Whether the contacts that have just been made are closed there.
bool ArcSteps::still_closed(const Equilibrium& e) {
  const ContactSet closed = closed_contacts(newton_.energy(), e);
  return std::all_of(just_made_.begin(), just_made_.end(), [&](const ContactKey& key) { return closed.count(key) > 0; });
}

// Whether a step of the load factor goes over a bend; behind a contact that has just changed the tangent is another one.
bool ArcSteps::over_bend(const Candidate& c) {
  if (current_.slack || current_.pushed || !at_contact_) return false;
  const Kinematics& kinematics = newton_.energy().kinematics();
  const double way = std::abs(c.e.point.state.load_factor - current_.point.state.load_factor);
  const auto over = [&](const Equilibrium& from) { return bends(kinematics, from, c.e, load_steps::most_bend); };
  return over(current_) && over(past_contact(load_steps::past_contact * way));
}

// A step of the length s and what happens on it; else `better` is a length that suits the step, 0: a shorter one.
std::optional<Branch::Candidate> ArcSteps::attempt(double s, const Direction& towards, bool along_contact, int& shifts, double& better, std::string& why) {
  const Arc arc(newton_, current_, towards, metric_);
  std::optional<Candidate> c = reach(arc, s, why);
  std::optional<Segment> fading;
  const bool kink = !c && !along_contact && !kink_refused_ && (c = reach_kink(arc, s, fading)).has_value() && !c->events.empty();
  if (!c) return {};
  if (along_contact && !still_closed(c->e)) return why = "a contact that has just been made opens again", std::nullopt;
  if (!kink) {
    const double change = std::abs(c->e.point.state.load_factor - current_.point.state.load_factor);
    if (change > 1.5 * options_.load_step) return better = s * std::clamp(0.9 * std::sqrt(options_.load_step / change), 0.1, 0.9), std::nullopt;
    const bool ends_on_event = c->e.point.stability.critical > 0 && c->e.zero_modes.cols() > current_.zero_modes.cols();
    if (ends_on_event && shifts++ < arc_steps::most_shifts) return better = 0.87 * s, std::nullopt;      // by chance: let it be inside of a step
  }
  if (negative_ < 0 && !look_beyond(arc, *c)) return better = arc_steps::just_beyond * s, std::nullopt;
  const Segment segment = fading ? *fading : beside({0, c->parameter, [&](double t, const Equilibrium& nearest) { return on(arc, t, nearest); },
                                  [&](State& state, const Eigen::MatrixXd& held) { return arc.settle(state, held); },
                                  [&](const State& state) { return arc.position(state); }, [&](const Equilibrium& e) { return arc.load_rate(e); },
                                  [&](const Equilibrium& from, const Equilibrium& to) { return joins(arc, from, to); }}, *c);
  if (!kink && !find_events(segment, *c, why)) return {};
  if (kink && !is_critical(deciding(*c)) && !find_critical(segment, *c, why)) return kink_refused_ = true, std::nullopt;
  if (kink && !find_user_events(segment, *c, why)) return {};
  if (!find_stop(segment, *c, why)) return {};
  if (fading) c->parameter = arc.position(c->e.point.state);
  return c;
}

// The equilibrium a step further, if it is on the same branch.
std::optional<Branch::Candidate> ArcSteps::reach(const Arc& arc, double s, std::string& why) {
  Equilibrium e = arc.at(s, current_);
  if (!e.point.report.converged() && neutral_.cols() > 0) {
    Equilibrium from = current_;
    from.zero_modes = without_force(newton_.energy(), from.zero_modes);
    e = arc.at(s, from);
  }
  if (!e.point.report.converged()) return why = e.point.report.why, std::nullopt;
  if (!stays_on_branch(arc, s, e, why)) return {};
  if (!e.slack) e.soft_values = newton_.factors().soft_values(std::min(equilibrium::softest, newton_.energy().dofs()));
  if (softens()) see_softest(newton_, e, current_.softest, -branch::little * s * arc.load_rate(e));
  carry_neutral(e);
  return Candidate{.parameter = s, .e = std::move(e)};
}

bool ArcSteps::stays_on_branch(const Arc& arc, double s, const Equilibrium& e, std::string& why) const {
  const Direction& start = arc.direction();
  if (arc.distance(e.point.state) > arc_steps::largest_departure * s) return why = "the corrector moved further than the predictor", false;
  const Direction d = direction_of(e, metric_, start);
  if (cosine(d, start, metric_) < std::cos(arc_steps::largest_angle)) return why = "the branch turns too sharply", false;
  const Vector x = newton_.energy().kinematics().difference(current_.point.state, e.point.state);
  const Chord c = chord(x, e.point.state.load_factor - current_.point.state.load_factor, start, d, metric_);
  if (c.defect > arc_steps::largest_defect)
    return why = "the branch bends too sharply, or there is another one beside it", false;
  // Where positions make up the step, the load factor alone tells whether its rates at both ends lead from the one to the other. Asked of unstable branches: of
  // stable ones the energy tells (lower_already).
  const double bound = std::max(2 * c.part * arc_steps::largest_defect * std::max(std::abs(d.load), std::abs(start.load)), arc_steps::told_by_load * options_.load_step);
  if (negative_ > 0 && !singular_ && !at_contact_ && std::abs(c.off.load) > bound)
    return why = "the load factor does not change as its rates tell: the branch bends too sharply, or there is another one beside it", false;
  return true;
}

// Of a branch that leaves a branch point: whether the index and the sign of dλ/ds are the same right behind it as at the candidate. There rounding may be more than
// the rate, of slender structures; then it is not what the change of the load factor tells:  s dλ/ds = m Δλ, m = 1 of a line, 2 of a parabola, 4 of a symmetric cusp.
bool ArcSteps::look_beyond(const Arc& arc, const Candidate& c) {
  const Equilibrium near = on(arc, arc_steps::just_beyond * c.parameter, current_);
  if (!near.point.report.converged()) return false;
  const auto rises = [&](const Equilibrium& e) { return direction_of(e, metric_, arc.direction()).load >= 0; };
  const auto told = [&](const Equilibrium& e) {
    const double m = arc.position(e.point.state) * arc.load_rate(e) / (e.point.state.load_factor - current_.point.state.load_factor);
    return m > arc_steps::least_order && m < arc_steps::largest_order;
  };
  if (near.point.stability.negative != c.e.point.stability.negative || (rises(near) != rises(c.e) && (told(near) || !told(c.e)))) return false;
  negative_ = near.point.stability.negative, sign_ = rises(c.e) ? 1 : -1;
  return true;
}

Equilibrium ArcSteps::on(const Arc& arc, double t, const Equilibrium& nearest) {
  Equilibrium e = arc.at(t, nearest);
  if (e.point.report.converged()) carry_neutral(e);
  return e;
}

// As long as it is next to nothing beside the next stiffness, what is neutral stays so, and held.
void ArcSteps::carry_neutral(Equilibrium& e) {
  const int count = static_cast<int>(neutral_.cols());
  if (e.zero_modes.cols() < count) take_nearly_neutral(newton_, e, count, neutral_);
}

// Or, where the branch may end or turn back in a kink, the kink; `fading`: the way to it, where arc length does not tell it. Kinks that nobody asks for are looked
// for only where stability may end with a contact.
std::optional<Branch::Candidate> ArcSteps::reach_kink(const Arc& arc, double s, std::optional<Segment>& fading) {
  std::optional<ContactChange> change = kink_ahead(newton_, closed_, current_, s * arc.direction().x, s * arc.direction().load, contacts_);
  if (!change) return {};
  const double t = arc.position(change->at.point.state);
  if (!(t >= -arc_steps::standing * s) || t > 1.5 * s || arc.distance(change->at.point.state) > std::max(arc_steps::largest_departure * t, arc_steps::standing * s)) return {};
  Equilibrium lost = change->beyond.value_or(change->at);
  lost.point.report = change->at.point.report;
  if (lost.point.stability.negative != negative_ && (fading = fades(*change, lost))) {
    Candidate c{.parameter = fading->b, .e = lost};
    const auto bears = [&](const ContactKey& key) { return !change->after.count(key) && borne(newton_.energy(), key, c.e.point.state) > contact_event::unloaded; };
    // Where what is lost bears nothing any more, or the load factor has not gone as far, the limit point cannot be told from the loss: then they are one event.
    std::string why;
    const bool found = find_critical(*fading, c, why), beyond = sign_ * (c.e.point.state.load_factor - lost.point.state.load_factor) >= 0;
    if (found && beyond && c.events.front().kind == EventKind::limit && std::any_of(closed_.begin(), closed_.end(), bears)) return c;
    if (!found && change->at.point.stability.negative == lost.point.stability.negative)       // the same search would fail again
      return kink_refused_ = true, std::nullopt;
    fading.reset();
  }
  if (!contacts_ && lost.point.stability.negative == negative_) return {};
  if (t > arc_steps::standing * s && !joins(arc, change->at, current_) && !(fading = fades(*change, lost))) return {};
  if (!fading && t > arc_steps::standing * s)
    if (auto earlier = before_it_leaves([&](double at, const Equilibrium& nearest) { return arc.at(at, nearest); }, 0, t, change->after)) return earlier;
  return with_contact(Candidate{.parameter = fading ? fading->b : t, .e = {}, .stands = !fading && t <= arc_steps::standing * s}, std::move(*change));
}

// The branch to where a contact is lost over what is left of it, if it leads there.
std::optional<Segment> ArcSteps::fades(const ContactChange& change, const Equilibrium& lost) {
  for (const ContactKey& key : closed_) {
    if (key.feature >= 0 || change.after.count(key) || !(gap(newton_.energy(), key, current_.point.state) < 0)) continue;
    Segment segment = segment_of_fading(newton_, key, current_, options_.load_step);
    if (!segment.leads(current_, lost)) continue;
    segment.at = [this, at = std::move(segment.at)](double t, const Equilibrium& nearest) {
      Equilibrium e = at(t, nearest);
      if (e.point.report.converged() && others_change(e)) e.point.report.status = Status::not_converged, e.point.report.why = "another contact changes on the way";
      return e;
    };
    return segment;
  }
  return {};
}

// Whether there are contacts that are closed at an equilibrium and open where the step begins, or the other way round, but for those that just touch.
bool ArcSteps::others_change(const Equilibrium& e) const {
  Energy& energy = newton_.energy();
  const ContactSet others = difference(closed_contacts(energy, e), closed_);
  return std::any_of(others.begin(), others.end(), [&](const ContactKey& key) { return !just_touches(energy, key, e.point.state); });
}

// A step and its two parts meet.
bool ArcSteps::joins(const Arc& arc, const Equilibrium& start, const Equilibrium& end) const {
  const Arc from(newton_, start, direction_of(start, metric_, arc.direction()), metric_);
  State state;
  if (!from.correct(state, from.position(end.point.state), start).converged()) return false;
  const double way = apart(start.point.state, end.point.state), missed = apart(state, end.point.state);
  return missed <= arc_steps::same_end * std::max(way, arc_steps::same_end * std::abs(arc.position(end.point.state))) ||
         missed <= left_by_rounding(newton_, state, start.zero_modes) / metric_.length;
}

double ArcSteps::apart(const State& a, const State& b) const {
  const Vector x = newton_.energy().kinematics().difference(a, b);
  const double load = b.load_factor - a.load_factor;
  return std::sqrt(metric_.dot(x, load, x, load));
}

// A part of a load step further, or the next stop where that comes before.
double ArcSteps::next_load(double part) const {
  const double here = current_.point.state.load_factor;
  double next = here + sign_ * part * options_.load_step;
  for (const double stop : options_.stops)
    if ((stop - here) * sign_ > 0 && (stop - next) * sign_ < 0 && !(last_stop_ && stop == *last_stop_)) next = stop;
  return next;
}

// Whether it is a stop but for rounding, which may put it on either side.
bool ArcSteps::stands_at(const Equilibrium& e, double stop) const {
  const double here = e.point.state.load_factor;
  return std::abs(here - stop) <= arc_steps::load_rounding * std::max({std::abs(here), std::abs(stop), options_.load_step});
}

// The first of the load factors to stop at, exactly there; false if it is passed, but not found.
bool ArcSteps::find_stop(Segment segment, Candidate& c, std::string& why) {
  const double from = current_.point.state.load_factor, to = c.e.point.state.load_factor;
  std::optional<double> first;
  for (const double stop : options_.stops) {
    if (last_stop_ && stop == *last_stop_) continue;
    const bool crosses = (from - stop) * (to - stop) <= 0;
    if (!crosses && !stands_at(current_, stop) && (deciding(c) || !stands_at(c.e, stop))) continue;
    if (!first || std::abs(stop - from) < std::abs(*first - from)) first = stop;
  }
  if (!first || (is_critical(deciding(c)) && std::abs(to - *first) <= arc_steps::same_stop * std::max(std::abs(from), std::abs(to)))) return true;
  segment.b = c.parameter;
  Equilibrium e;
  double s = 0;
  const auto lies_between = [&] {
    s = e.point.report.converged() ? segment.parameter(e.point.state) : -c.parameter;
    return s >= -arc_steps::standing * c.parameter && s <= c.parameter * (1 + arc_steps::standing);
  };
  bool found = false;
  if (std::optional<Equilibrium> guess = foreseen(segment, c, *first)) e = std::move(*guess), found = lies_between();
  if (!found) {
    const std::optional<Event> near = locate_root(segment, current_, c.e, [&](const Equilibrium& at) { return at.point.state.load_factor - *first; });
    e = at_load(near ? near->at : c.e, *first), found = lies_between();
  }
  if (!found) {
    why = fmt::format("no equilibrium was found at load factor {:.10g}, which the step passes", *first);
    return (from - *first) * (to - *first) >= 0;
  }
  const auto elsewhere = [&](const Event& event) { return event.kind != EventKind::user || std::abs(event.at_parameter - s) > branch::coincide * c.parameter; };
  std::erase_if(c.events, elsewhere);
  c.parameter = std::max(s, 0.0), c.e = std::move(e), c.stop = first;
  return true;
}

// The equilibrium at a load factor that the segment passes, from where Hermite's cubic has it; nothing if it is not right there.
std::optional<Equilibrium> ArcSteps::foreseen(const Segment& segment, const Candidate& c, double load_factor) {
  if (neutral_.cols() > 0 || direction_.load == 0) return {};
  const Kinematics& kinematics = newton_.energy().kinematics();
  double low = segment.a, high = segment.b;
  const std::function<double(double)> load_at = load_along(segment, current_, c.e);
  const bool rises = current_.point.state.load_factor < load_factor;
  for (int k = 0; k < arc_steps::cubic_halvings; ++k) {
    const double middle = (low + high) / 2;
    ((load_at(middle) < load_factor) == rises ? low : high) = middle;
  }
  State state = interpolate(kinematics, segment, current_, c.e, segment.a, segment.b, (low + high) / 2).state;
  kinematics.prescribe(state, load_factor);
  const State guess = state;
  const Report report = newton_.correct(state, current_.zero_modes, &current_.point.state, equilibrium::most_iterations);
  const double way = kinematics.difference(current_.point.state, c.e.point.state).norm();
  if (!report.converged() || kinematics.difference(guess, state).norm() > arc_steps::as_foreseen * way) return {};
  if (newton_.energy().collision_free_step(current_.point.state, state) < 1) return {};
  return assess(newton_, state, report);
}

// The equilibrium at a load factor, from one that is near: as load steps find it, with what is neutral in its phase, or, where no step of the load
// factor can be told from rounding, as it is.
Equilibrium ArcSteps::at_load(const Equilibrium& from, double load_factor) {
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

Waypoint ArcSteps::accept(Candidate c) {
  const Event* event = deciding(c);
  neutral_ = !event && c.e.point.stability.critical > 0 ? c.e.zero_modes : Eigen::MatrixXd();
  if (neutral_.cols() > 0) name_neutral(c.e.point.stability);
  last_stop_ = c.stop, taken_ = c.natural ? 0 : c.parameter;
  const bool kink = event && event->beyond;
  // Nothing may have moved before a contact.
  if (const Equilibrium& e = kink ? *event->beyond : c.e; c.natural && (kink ? current_.slack : at_contact_ && !is_critical(event)))
    metric_.length = std::max(metric_.length, metric_.load * e.tangent.norm());
  if (c.natural && !kink && !is_critical(event)) {
    direction_ = direction_of(c.e, metric_, {Vector::Zero(c.e.tangent.size()), sign_ * metric_.load});
  } else {
    rotate(c);
  }
  const double way = apart(current_.point.state, c.e.point.state);
  const bool unstable = negative_ > 0;
  take(c);
  tell_tangent();
  if (kink) step_ = std::min(step_, longest());
  else if (c.natural) step_ = longest(), shortest_ = std::min(shortest_, arc_steps::least_part * step_);
  // Where steps of arc length have been refused another branch may be near: they grow again from what has been taken. Of stable ones the energy tells (lower_already).
  if (c.natural && unstable && c.events.empty()) step_ = std::min(step_, arc_steps::most_growth * way);
  return {std::move(c.e), std::move(c.events), c.stop};
}

// The direction from the candidate on, and the next step from how this one went.
void ArcSteps::rotate(const Candidate& c) {
  const Event* event = deciding(c);
  const bool kink = event && event->beyond, arrival = event && event->arrival, limit = is_critical(event) && event->kind == EventKind::limit;
  // At a limit point the branch goes along the critical mode, which may be all but square to where it has been going.
  const bool tells = limit && event->passing.size() > 0;
  Direction next = direction_of(kink ? *event->beyond : c.e, metric_, tells ? Direction{event->passing, 0} : direction_);
  if (kink && event->onward != 0 && sign_of(next.load) != event->onward) next.x = -next.x, next.load = -next.load;
  const bool contact = event && !kink && event->kind == EventKind::contact && event->before == event->after;
  if (contact && sign_of(next.load) != sign_) next.x = -next.x, next.load = -next.load;        // the determinant keeps its sign
  if (arrival) next = passing(*event, metric_);                 // on along the side branch, to its other half
  if (arrival != limit) sign_ = -sign_;
  if (arrival || limit) next.load = std::copysign(next.load, sign_);      // else rounding's
  else if (!is_critical(event)) sign_ = sign_of(next.load);
  const double angle = std::acos(std::clamp(cosine(next, direction_, metric_), -1.0, 1.0));
  direction_ = std::move(next);
  if (!c.events.empty() || c.stop) return;
  const double ease = std::exp2((arc_steps::wanted_iterations - std::max(1, c.e.point.report.iterations)) / 2.0);
  step_ = c.parameter * std::clamp(std::min(ease, arc_steps::wanted_angle / std::max(angle, 1e-9)), 0.25, arc_steps::most_growth);
  weigh(c.e);
}

// Where the equations are singular they do not tell it.
void ArcSteps::tell_tangent() {
  if (singular_ && direction_.load != 0) current_.tangent = direction_.x / direction_.load;
}

// How the branch goes on behind the contacts that have just been made, if they are stiff.
std::optional<Direction> ArcSteps::along_contact() {
  just_made_ = just_touching(newton_.energy(), current_.point.state, closed_);
  const std::optional<Rates> rates = just_made_.empty() ? std::nullopt : along_contacts(newton_, current_, just_made_, metric_.load);
  if (!rates) return {};
  const double size = std::sqrt(metric_.dot(rates->x, rates->load, rates->x, rates->load));
  return Direction{rates->x / size, rates->load / size};
}

// Positions must not weigh less than the load factor, or the steps would be load steps: L ≤ Λ |dx/dλ|.
void ArcSteps::weigh(const Equilibrium& e) {
  const double length = std::max(metric_.load * e.tangent.norm(), least_length_);
  if (length >= metric_.length) return;
  metric_.length = length;
  const double size = std::sqrt(cosine(direction_, direction_, metric_));
  direction_.x /= size, direction_.load /= size;
  step_ *= size, shortest_ *= size;
}

}  // namespace elamin
