#include "path/continuation.hpp"

#include "core/find.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "path/cause.hpp"
#include "path/family.hpp"
#include "path/jump.hpp"
#include "path/limits.hpp"
#include "path/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace elamin {

using namespace limits;

namespace {

// The two particles of a bond that has shrunk to nothing, where its energy has a kink and a branch its end; else "".
std::string collapsed(const Model& model, const State& state) {
  for (const Bond& b : model.bonds) {
    const auto [i, j] = b.particles;
    if ((state.at(j) - state.at(i)).hi.norm() <= continuation::collapsed_bond * model.bond_types[b.type].rest_length)
      return fmt::format("{} and {}, which a bond joins, come together", called(model, i), called(model, j));
  }
  return "";
}

}  // namespace

Continuation::Continuation(Newton& newton, const State& start, PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), options_(std::move(options)), start_(start) {}

Continuation::Continuation(Newton& newton, SideBranch side, std::string parent, const std::vector<Event>& known, Metric metric,
                           PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), options_(std::move(options)), side_(std::move(side)), known_(known), metric_(metric) {
  options_.method = PathMethod::arc_length;
  parent_ = std::move(parent);
  for (const Event& event : known_) family_ = std::max(family_, static_cast<int>(event.modes.cols()) - 1);
}

void Continuation::carry(Archive& archive) {
  Path::carry(archive);
  bool begun = steps_ != nullptr;
  archive(begun, metric_);
  if (archive.reads()) steps_.reset();
  if (archive.reads() && begun) set_out({.closed = {}, .sides = std::vector<double>(options_.user_events.size())}, {}, 1);
  archive(first_, first_direction_, left_, travelled_, points_, family_, arrived_at_, arrival_);
  if (begun) archive(*steps_);
}

void Continuation::advance() {
  if (!steps_) return begin();
  const int most = options_.most_points > 0 ? options_.most_points : 20 * options_.steps;
  if (arcs() && ++points_ > most)
    return end(Status::converged, fmt::format("stopped after {} points of one branch (path.points), at load factor {:.10g}", most,
                                              steps_->at().point.state.load_factor));
  std::optional<Waypoint> waypoint = steps_->next();
  if (waypoint) show(std::move(*waypoint));
  else break_off();
}

void Continuation::begin() {
  if (side_) {
    branch_ = ++numbering().branches;
    Equilibrium at = side_->at;
    at.point.label.clear();
    return set_out({.at = at, .closed = closed_contacts(newton_.energy(), at)}, side_->direction, side_->step);
  }
  std::string sentence;
  const double at = options_.start.value_or(options_.from);
  Equilibrium e = first_equilibrium(newton_, start_, at, options_.when_unstable, options_.resume.has_value(), options_.descend, sentence);
  if (!sentence.empty()) note(sentence);
  if (!e.point.report.converged()) return end(e.point.report.status, e.point.report.why);
  metric_ = metric_for(newton_.energy(), e, range());
  if (arcs())
    note(fmt::format("arc length: |(x, λ)|² = |x|²/L² + λ²/Λ², |x| over all free coordinates, Λ = {:.4g}, L = {:.4g} and further on the least "
                     "Λ |dx/dλ| of the branch so far", metric_.load, metric_.length));
  e.point.label = "initial";
  emit(e.point);
  e.point.label.clear();
  if (options_.resume && (!arcs() || options_.resume->direction.size() == e.tangent.size())) return take_up(std::move(e), *options_.resume);
  if (options_.when_unstable == WhenUnstable::stop) {
    // At a limit point, where a stage has stopped, the sign of the eigenvalue that vanishes is rounding's, and the tangent ~ 1/μ would rotate bonds by 10⁶ rad over the range.
    const bool singular = distortion(newton_.energy(), e.point.state, e.tangent, 1) * std::abs(range()) * equilibrium::next_to_nothing > 1;
    if (e.point.stability.negative > 0 || singular) take_nearly_neutral(newton_, e, 1, {});
    if (e.point.stability.negative > 0) return end(Status::converged, "the starting state is unstable");
  }
  e = back_from_limit(std::move(e));
  ContactSet closed = closed_contacts(newton_.energy(), e);
  const int negative = e.point.stability.negative;
  const Direction direction = towards_end(e);
  set_out({.at = std::move(e), .negative = negative, .closed = std::move(closed)}, direction);
}

// From a limit point, where a stage has stopped, back along its stable branch: a step of the load factor has no tangent there, but a little farther back there is
// a minimum beside it, along the critical mode. Else the equilibrium as it is.
Equilibrium Continuation::back_from_limit(Equilibrium limit) {
  Energy& energy = newton_.energy();
  if (limit.point.stability.negative > 0 || limit.zero_modes.cols() != 1) return limit;
  energy.evaluate(limit.point.state);
  const Vector load = energy.load_derivative(), mode = limit.zero_modes.col(0);
  if (!(std::abs(mode.dot(load)) > locate::orthogonal * load.norm())) return limit;
  State state = limit.point.state;
  energy.kinematics().prescribe(state, state.load_factor + continuation::snap_beyond.front() * range());
  const Report report = newton_.minimise(state, Pace::downhill);
  const Vector way = energy.kinematics().difference(limit.point.state, state);
  if (!report.converged() || std::abs(mode.dot(way)) < continuation::along_mode * way.norm()) return limit;
  Equilibrium back = assess(newton_, state, report);
  return back.point.stability.negative == 0 && back.zero_modes.cols() == 0 ? back : limit;
}

Direction Continuation::towards_end(const Equilibrium& e) const {
  return direction_of(e, metric_, {Vector::Zero(e.tangent.size()), range() > 0 ? metric_.load : -metric_.load});
}

// As if the path had never stopped here.
void Continuation::take_up(Equilibrium at, const Resume& resume) {
  if (arcs()) metric_.length = resume.length;
  Departure from{.negative = resume.after >= 0 ? resume.after : at.point.stability.negative, .closed = resumed_contacts(resume)};
  std::optional<Event> event = resumed_event(resume, at);
  if (event) {
    if (!goes_on_behind(*event)) return;
    at = event->at;
  }
  if (resume.tangent.size() == at.tangent.size()) at.tangent = resume.tangent;
  at.point.label.clear();
  at.point.stability.critical = 0;
  from.at_contact = resume.label.starts_with("contact:"), from.singular = event.has_value();
  for (const UserEvent& w : options_.user_events) from.sides.push_back(resume.label.starts_with(w.name + ":") ? 0 : w.side(at.point.state));
  from.at = std::move(at);
  // Of unit length in the metric of the path that stopped here: another range of load factors has another one, and other steps.
  Direction direction{resume.direction, resume.load};
  const double size = arcs() ? std::sqrt(cosine(direction, direction, metric_)) : 1;
  if (std::abs(size - 1) < 1e-9) return set_out(std::move(from), direction, resume.step, resume.shortest);
  direction.x /= size, direction.load /= size;
  set_out(std::move(from), direction);
}

void Continuation::set_out(Departure from, const Direction& direction, double step, double shortest) {
  if (arcs()) {
    ArcOptions a = arc_options(options_);
    a.step = step, a.shortest = shortest;
    first_ = from.at, first_direction_ = direction, left_ = false, travelled_ = 0;
    steps_ = std::make_unique<ArcSteps>(newton_, std::move(from), direction, metric_, std::move(a));
  } else {
    steps_ = std::make_unique<LoadSteps>(newton_, std::move(from), options_);
  }
}

void Continuation::show(Waypoint waypoint) {
  const double load = waypoint.at.point.state.load_factor;
  if (waypoint.events.size() == 1 && waypoint.events.front().slides && slides_away(waypoint.at)) return;
  waypoint.at.point.resume = resume_here(waypoint);
  if (arcs()) {
    const Vector from_first = newton_.energy().kinematics().difference(first_.point.state, waypoint.at.point.state);
    const double change = load - first_.point.state.load_factor;
    travelled_ = std::max(travelled_, std::sqrt(arc_steps().metric().dot(from_first, change, from_first, change)));
  }
  for (Event& event : waypoint.events) {
    event.at.point.resume = waypoint.at.point.resume;
    const bool located = event.kind == EventKind::limit ? options_.limits : event.kind == EventKind::branch ? options_.branch_points
                       : event.kind == EventKind::contact ? options_.contacts : true;
    if (event.kind == EventKind::branch && meets_known(waypoint, event)) return;
    if (located) emit(event);
    else emit(waypoint.at.point);
  }
  for (const Event& event : waypoint.events)
    if (event.kind == EventKind::user && options_.user_events[event.user_event].stop)
      return end(Status::converged, fmt::format("{} reached at load factor {:.10g}", event.what, load));
  for (Event& event : waypoint.events)
    if (event.kind != EventKind::user && !goes_on_behind(event)) return;
  if (!waypoint.events.empty() && !waypoint.stop) return;
  emit(waypoint.at.point);
  if (!arcs()) return;
  if (waypoint.stop) {
    const double stop = *waypoint.stop;
    if (stop == options_.to) return end_reached();
    if (!contains(options_.stops, stop))
      return end(Status::converged, fmt::format("the branch leaves the range of load factors at {:.10g}", stop));
  }
  if (closes_loop(waypoint)) end(Status::converged, fmt::format("the branch closes to a loop at load factor {:.10g}", load));
}

// What the state alone does not tell of how the path goes on from here.
std::optional<Resume> Continuation::resume_here(const Waypoint& waypoint) const {
  const bool any = !waypoint.events.empty();
  if (!arcs() && !any) return {};
  Resume r = any ? resume_of(waypoint.events.front(), steps_->closed()) : Resume{};
  if (!any) store(steps_->closed(), r);
  r.tangent = waypoint.at.tangent;
  if (!arcs()) return r;
  r.direction = arc_steps().direction().x, r.load = arc_steps().direction().load;
  r.length = arc_steps().metric().length, r.step = arc_steps().step(), r.shortest = arc_steps().shortest();
  return r;
}

// Whether the path goes on along the branch behind an event; else it has ended or snapped.
bool Continuation::goes_on_behind(Event& event) {
  const std::string at = fmt::format("{}, load factor {:.10g}", event.at.point.label.empty() ? "the loss of stability" : event.at.point.label,
                                     event.at.point.state.load_factor);
  // Where the load factor turns at a contact the branch may be stable on both sides, but goes back: a path of stable states cannot take it.
  const bool stable_only = options_.when_unstable == WhenUnstable::jump && event.before == 0;
  const bool loses = event.before == 0 && event.after > 0, ends = event.kind == EventKind::limit && (!arcs() || stable_only);
  const double load = event.at.point.state.load_factor;
  const bool stops = loses && options_.when_unstable == WhenUnstable::stop;
  if (event.kind != EventKind::contact && !stops && at_end(load)) return end_reached(), false;
  if (!loses && !ends) return !crosses_over(event);
  if (left_of_path(load) < continuation::least_snap && !ends && !stops) return true;        // the end is nearer than a snap may begin
  switch (options_.when_unstable) {
    case WhenUnstable::jump: jump(event); return false;
    case WhenUnstable::stop:
      if (loses) return end(Status::converged, "stopped at " + at), false;
      break;
    case WhenUnstable::follow: break;
  }
  if (ends) end(Status::not_converged, at + ": load steps cannot follow the branch beyond; use path.method = \"arc_length\"");
  return !ends;
}

// The part of the path that lies behind a load factor.
double Continuation::left_of_path(double at) const { return (options_.to - at) / range(); }

// Where the path has snapped to its end, or has an event there, all that a branch may stop at lies behind.
bool Continuation::at_end(double load) const { return left_of_path(load) <= continuation::all_of_path; }

void Continuation::end_reached() { end(Status::converged, fmt::format("load factor {:.10g} reached", options_.to)); }

// Where one equilibrium of a family comes to a contact the path goes on from another one: no event, which one it was is the steps' choice.
bool Continuation::slides_away(Equilibrium at) {
  if (arcs() && arc_steps().direction().load * range() < 0) return false;       // steps would begin anew the other way
  if (!moves_in_family(at)) return false;
  begin_at(at);
  emit(std::move(at.point));
  return true;
}

// Where a stable branch meets another one and goes back, which load steps do not: a path of stable states goes on along the other one.
bool Continuation::crosses_over(const Event& event) {
  if (!event.arrival || !arcs() || !steps_ || options_.when_unstable != WhenUnstable::jump || event.before + event.after > 0) return false;
  if (arc_steps().direction().load * range() >= 0) return false;
  Equilibrium held = event.at;
  held.zero_modes = side_by_side(held.zero_modes, event.modes);
  const double here = event.at.point.state.load_factor;
  double way = snap_begins(options_, here, continuation::snap_beyond.back()) - here;
  Equilibrium other = continue_to(newton_, held, here + way);
  // What is all but critical, too, may bend more on this way than its tangent tells: then nearer.
  for (int k = 0; k < continuation::most_nearer && !other.point.report.converged(); ++k) other = continue_to(newton_, held, here + (way /= 4));
  if (!other.point.report.converged() || other.point.stability.negative > 0) return jump(event), true;
  const double load = other.point.state.load_factor;
  begin_anew(other);
  emit(std::move(other.point));
  if (at_end(load)) end_reached();
  return true;
}

// Just past the event the branch has turned unstable or ended: the state snaps to the minimum below.
void Continuation::jump(const Event& event) {
  std::string what;
  family_ = std::max(family_, static_cast<int>(event.modes.cols()) - 1);
  Equilibrium landed;
  for (const double way : continuation::snap_beyond) {
    landed = jump_from(newton_, event, snap_begins(options_, event.at.point.state.load_factor, way), what);
    if (landed.point.report.status != Status::not_converged) break;
  }
  note(fmt::format("jump at {}: {}", event.at.point.label, what));
  if (!landed.point.report.converged()) return end(landed.point.report.status, landed.point.report.why);
  land(std::move(landed), what, event.before, event.at.point.label);
}

// Of a family one that is away from contacts, if there is one.
bool Continuation::moves_in_family(Equilibrium& at) {
  if (family_ == 0) return false;
  hold_family(newton_, at, family_);
  if (!move_from_contacts(newton_, at)) return false;
  note(fmt::format("load factor {:.10g}: the path goes on from another equilibrium of the same family, away from contacts", at.point.state.load_factor));
  return true;
}

void Continuation::begin_anew(Equilibrium& at) {
  std::ignore = moves_in_family(at);
  begin_at(at);
}

// Steps begin anew.
void Continuation::begin_at(Equilibrium& at) {
  ContactSet closed = closed_contacts(newton_.energy(), at);
  set_out({.at = at, .negative = at.point.stability.negative, .closed = std::move(closed)}, towards_end(at));
  at.point.resume = resume_here({at});
}

// The path goes on from where it has snapped to.
void Continuation::land(Equilibrium at, const std::string& what, int before, const std::string& parent) {
  const double load = at.point.state.load_factor;
  begin_anew(at);
  emit_landing(std::move(at.point), what, before, parent);
  if (at_end(load)) end_reached();
}

// The branch cannot be followed any further, or there is nothing left to hit.
void Continuation::break_off() {
  if (steps_->status() != Status::not_converged) return end(steps_->status(), steps_->why());
  std::string no_snap;
  const bool stable = !arcs() || (steps_->negative() == 0 && arc_steps().direction().load * range() > 0);
  if (options_.when_unstable == WhenUnstable::jump && stable && (snap(no_snap) || (!arcs() && load_steps().search()))) return;
  const State& last = steps_->at().point.state;
  if (const std::string together = collapsed(newton_.energy().model(), last); arcs() && !together.empty())
    return end(Status::converged, fmt::format("the branch ends at load factor {:.10g}, where {}", last.load_factor, together));
  const std::string cause = cause_at(newton_, steps_->at());
  end(Status::not_converged, steps_->why() + no_snap + (cause.empty() ? "" : "; " + cause));
}

// Whether the minimum that a step led to goes back to where it came from as the load does: what has snapped does not.
bool Continuation::comes_back(const Equilibrium& landed, const Equilibrium& from) {
  const Kinematics& kinematics = newton_.energy().kinematics();
  State state = landed.point.state;
  kinematics.prescribe(state, from.point.state.load_factor);
  if (newton_.energy().collision_free_step(landed.point.state, state) < 1 || !go_down(newton_, state).converged()) return false;
  const double way = kinematics.difference(from.point.state, landed.point.state).norm();
  return kinematics.difference(from.point.state, state).norm() <= equilibrium::same_end * way;
}

// Where the branch ends within the finest step, at an event that could not be resolved, or in more of them than steps can tell: the minimum
// that is reached by going down from there, beyond.
bool Continuation::snap(std::string& why) {
  const Equilibrium last = steps_->at();
  const double at = last.point.state.load_factor, target = arcs() ? snap_begins(options_, at, continuation::snap_beyond.back()) : load_steps().goal();
  State state = last.point.state;
  newton_.energy().kinematics().prescribe(state, target);
  if (newton_.energy().collision_free_step(last.point.state, state) < 1) return false;
  const double before = newton_.energy().value(state);
  const Report report = go_down(newton_, state);
  if (!report.converged()) why = fmt::format("; and no minimum was found beyond, at load factor {:.10g}: {}", target, report.why);
  if (!report.converged() || !(report.energy < before)) return false;
  Equilibrium landed = assess(newton_, state, report);
  const bool searched = arcs() || load_steps().searches();
  if (!bends(newton_.energy().kinematics(), last, landed, limits::load_steps::most_bend) || (!searched && comes_back(landed, last))) {
    if (searched) note(fmt::format("steps cannot tell what happens between load factors {:.10g} and {:.10g}; the branch goes on", at, target));
    begin_anew(landed);
    emit(std::move(landed.point));
    if (at_end(target)) end_reached();
    return true;
  }
  note(fmt::format("the branch ends at load factor {:.10g} in an event that {} located: snap from energy {:.10g} to {:.10g}",
                   at, searched ? "could not be" : "is not", before, report.energy));
  land(std::move(landed), fmt::format("from energy {:.10g} to {:.10g} at load factor {:.10g}", before, report.energy, target),
       steps_->negative(), "");
  return true;
}

// Whether this is a branch point that the diagram has already: then the branch ends there.
bool Continuation::meets_known(const Waypoint& waypoint, const Event& event) {
  if (known_.empty()) return false;
  const Kinematics& kinematics = newton_.energy().kinematics();
  const State& state = waypoint.at.point.state;
  const Metric& metric = arc_steps().metric();
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const State& other = known_[k].at.point.state;
    const Vector apart = kinematics.difference(other, state);
    const double load = state.load_factor - other.load_factor;
    if (std::sqrt(metric.dot(apart, load, apart, load)) > continuation::same_point * travelled_) continue;
    emit(waypoint.at.point);
    arrived_at_ = static_cast<int>(k);
    arrival_ = event.arrival ? Vector(-arc_steps().direction().x.normalized()) : Vector(Vector::Zero(apart.size()));
    end(Status::converged, fmt::format("the branch arrives at {}, load factor {:.10g}", known_[k].at.point.label, state.load_factor));
    return true;
  }
  return false;
}

// Whether the last step passed the point where the branch began, in the same direction, after it had left it.
bool Continuation::closes_loop(const Waypoint& waypoint) {
  const Metric& metric = arc_steps().metric();
  const Arc arc(newton_, waypoint.at, arc_steps().direction(), metric);
  const double s = arc.position(first_.point.state), away = arc.distance(first_.point.state), step = arc_steps().taken();
  if (!left_) {
    left_ = step > 0 && std::hypot(s, away) > 8 * step;         // a step of the load factor tells no length
    return false;
  }
  return s <= 0 && s > -step && away < 0.25 * step &&
         cosine(arc_steps().direction(), first_direction_, metric) > 0.5 * std::sqrt(cosine(first_direction_, first_direction_, metric));
}

}  // namespace elamin
