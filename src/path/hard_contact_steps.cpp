#include "path/hard_contact_steps.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "path/limits.hpp"
#include "path/load_steps.hpp"
#include "path/locate.hpp"
#include "path/root.hpp"
#include "solve/method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

using namespace limits;

namespace {

bool in(const std::vector<HardForce>& contacts, const HardForce& contact) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const HardForce& h) { return key(h) == key(contact); });
}

double force_of(const State& state, const HardForce& contact) {
  for (const HardForce& h : state.hard)
    if (key(h) == key(contact)) return h.force;
  return 0;
}

bool same(const std::vector<HardForce>& a, const std::vector<HardForce>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const HardForce& x, const HardForce& y) { return key(x) == key(y); });
}

void toggle(std::vector<HardForce>& contacts, const HardForce& contact) {
  if (std::erase_if(contacts, [&](const HardForce& h) { return key(h) == key(contact); }) > 0) return;
  contacts.push_back({contact.particle, contact.other, contact.wall, contact.face, 0});
  std::sort(contacts.begin(), contacts.end(), [](const HardForce& a, const HardForce& b) { return key(a) < key(b); });
}

// Who touches or leaves whom.
std::string told(const Model& model, const HardForce& h, bool made) {
  const std::string other = h.wall >= 0 ? "wall " + model.walls[h.wall].name : called(model, h.other);
  return called(model, h.particle) + (made ? " touches " : " leaves ") + other;
}

}  // namespace

HardContactSteps::HardContactSteps(Newton& newton, const State& start, PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), equilibrium_(newton.energy()), options_(std::move(options)), start_(start),
      targets_(load_targets(options_)) {}

void HardContactSteps::carry(Archive& archive) {
  Path::carry(archive);
  archive(interval_, halvings_, current_, closed_, slack_, side_, changes_, begun_);
}

void HardContactSteps::advance() {
  if (!begun_) begin();
  else step();
}

void HardContactSteps::begin() {
  begun_ = true;
  const double at = options_.start.value_or(options_.from);
  State state = start_;
  newton_.energy().kinematics().prescribe(state, at);
  Report report;
  State near = state;                                           // where it stands, perhaps, or was stored
  const Inertia inertia = newton_.energy().dofs() > 0 ? equilibrium_.inertia(near) : Inertia{};
  if (inertia.negative == 0) {
    const Eigen::MatrixXd held = inertia.zero > 0 ? equilibrium_.lowest(near, inertia.zero).vectors : Eigen::MatrixXd();
    report = equilibrium_.correct(near, newton_.tolerance(), nullptr, hard_contact_steps::near_by * newton_.energy().kinematics().smallest_size(), held);
    if (report.converged() && equilibrium_.inertia(near).negative == 0) state = near;
    else report = {};
  }
  if (!report.converged()) report = minimise(newton_, state, IpoptOptions{.tolerance = newton_.tolerance()});
  if (!report.converged()) return end(report.status, fmt::format("no equilibrium at the start, load factor {:.10g}: {}", at, report.why));
  Equilibrium first = assess(newton_, state, report);
  first.point.label = "initial";
  tell(first.point);
  first.point.label.clear();
  go_on(std::move(first));
}

// From an equilibrium where the branch begins.
void HardContactSteps::go_on(Equilibrium from) {
  closed_ = from.point.state.hard;
  halvings_ = changes_ = 0;
  const Contacts slack = judge(from, nullptr).slack;
  if (!slack.empty())
    if (const std::optional<Contacts> now = equilibrium_.onward(from.point.state, slack, direction()); now && !same(*now, closed_)) {
      closed_ = from.point.state.hard = *now;
      from = assess(newton_, from.point.state, from.point.report);
    }
  accept(std::move(from), slack);
}

// Forces that are nothing are not told.
void HardContactSteps::tell(PathPoint point) {
  newton_.energy().evaluate(point.state, false);
  std::erase_if(point.state.hard, [&](const HardForce& h) { return !(h.force > 0 && newton_.energy().relative(Vector::Constant(1, h.force)) > hard_contact_steps::rounding); });
  emit(std::move(point));
}

void HardContactSteps::accept(Equilibrium at, const Contacts& slack, const std::vector<Event>& passed) {
  current_ = std::move(at);
  slack_ = slack;
  const double load_factor = current_.point.state.load_factor;
  side_.resize(options_.user_events.size(), 0);
  pass_user_events(options_.user_events, passed, current_.point.state, side_);
  while (interval_ < targets_.size() && (load_factor - targets_[interval_]) * direction() >= 0) ++interval_;
}

// The equilibrium at the load factor with these contacts closed, whatever their forces.
Equilibrium HardContactSteps::follow(const Equilibrium& from, const Contacts& closed, double load_factor) {
  Energy& energy = newton_.energy();
  State state = from.point.state;
  const double change = load_factor - state.load_factor;
  energy.kinematics().prescribe(state, load_factor);
  energy.kinematics().retract(state, from.tangent, change);
  state.hard = closed;
  for (HardForce& h : state.hard) h.force = force_of(from.point.state, h);
  Report report = equilibrium_.settle(state, newton_.tolerance(), &from.point.state, ContactEquilibrium::anywhere, from.zero_modes);
  if (report.converged() && energy.collision_free_step(from.point.state, state) < 1)
    report.status = Status::not_converged, report.why = "the step would carry something through something else";
  if (report.converged()) return assess(newton_, state, report);
  Equilibrium failed;
  failed.point.state = state, failed.point.report = report;
  return failed;
}

// Below zero: the force of a contact that is closed, in parts of the largest; the gap of another one, in diameters. Of the energy's
// last evaluation.
double HardContactSteps::margin(const HardForce& contact, const Equilibrium& e) const {
  const Energy& energy = newton_.energy();
  if (in(closed_, contact)) {
    const double force = force_of(e.point.state, contact);
    return std::copysign(energy.relative(Vector::Constant(1, force)), force);
  }
  HardGap gap;
  return hard_gap(energy.model(), contact, e.point.state, gap) ? gap.value / energy.model().diameter[contact.particle] : 1.0;
}

// What vanishes so near that the way from the equilibrium before cannot tell it from here has neither gap nor force.
HardContactSteps::Judgement HardContactSteps::judge(const Equilibrium& e, const Equilibrium* before) {
  Energy& energy = newton_.energy();
  const State& state = e.point.state;
  Contacts all = closed_;
  for (const HardForce& h : energy.hard_contacts(state, hard_contact_steps::near_by * energy.kinematics().smallest_size()))
    if (!in(closed_, h)) all.push_back(h);
  energy.evaluate(state, false);                                // its force scale
  const double way = before ? std::abs(state.load_factor - before->point.state.load_factor) : 0;
  Judgement found;
  for (const HardForce& h : all) {
    const double left = margin(h, e), place = state.position.col(h.particle).cwiseAbs().maxCoeff() / energy.model().diameter[h.particle];
    double nothing = std::max(hard_contact_steps::rounding, 8 * epsilon * place);
    if (way > 0) nothing = std::max(nothing, std::abs(margin(h, *before) - left) * hard_contact_steps::together * std::abs(options_.to - options_.from) / way);
    if (left < -nothing) found.wrong.push_back(h);
    else if (left <= nothing) found.slack.push_back(h);
  }
  const auto in_order = [](const HardForce& a, const HardForce& b) { return key(a) < key(b); };
  std::sort(found.wrong.begin(), found.wrong.end(), in_order), std::sort(found.slack.begin(), found.slack.end(), in_order);
  return found;
}

// No step is cut in two that are very unequal.
void HardContactSteps::step() {
  const double here = current_.point.state.load_factor;
  if (interval_ == targets_.size()) return end(Status::converged, fmt::format("load factor {:.10g} reached", options_.to));
  if (interrupted()) return end(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", here));
  const double goal = targets_[interval_];
  const double step = std::ldexp((options_.to - options_.from) / options_.steps, -halvings_);
  const double target = std::abs(goal - here) <= 1.25 * std::abs(step) ? goal : here + step;

  Equilibrium candidate = follow(current_, closed_, target);
  if (!candidate.point.report.converged()) {
    if (halvings_ % hard_contact_steps::look_for_limit == hard_contact_steps::look_for_limit - 1)
      if (std::optional<Event> limit = limit_point(target)) return lose(std::move(*limit));
    return halve(target, candidate.point.report.why);
  }
  if (halvings_ < hard_contact_steps::finest && bends(newton_.energy().kinematics(), current_, candidate, hard_contact_steps::most_bend)) return halve(target, "the branch bends too much to be told from another one");
  Judgement judgement = judge(candidate, &current_);
  for (int k = 0; !judgement.wrong.empty(); ++k) {
    const auto dips = std::find_if(judgement.wrong.begin(), judgement.wrong.end(), [&](const HardForce& h) { return in(slack_, h); });
    const bool from_here = dips != judgement.wrong.end();
    if (from_here && halvings_ >= hard_contact_steps::short_enough && turn_back(*dips)) return;
    std::optional<Equilibrium> nearer = !from_here && k < hard_contact_steps::most_first ? first_change(judgement.wrong, candidate) : std::nullopt;
    if (!nearer) return halve(target, "contacts change in a way that could not be located");
    candidate = std::move(*nearer);
    judgement = judge(candidate, &current_);
  }
  const double arrived = candidate.point.state.load_factor;
  const int after = candidate.point.stability.negative;
  if (after != current_.point.stability.negative) {
    std::optional<Event> event = branch_point(candidate);
    if (!event && halvings_ % hard_contact_steps::look_for_limit == hard_contact_steps::look_for_limit - 1) event = limit_point(arrived);
    return event ? lose(std::move(*event)) : miss(arrived, after);
  }
  if (!same_branch(newton_.energy(), current_, candidate) && halvings_ < hard_contact_steps::finest) {
    return halve(arrived, "the corrector went to another branch");
  }
  const auto between = [&](double t, const Equilibrium& nearest) { return follow(nearest, closed_, t); };
  bool missed = false;
  Segment segment = segment_of_loads(newton_, here, arrived);
  segment.at = between;
  const std::vector<Event> seen = locate_user_events(options_.user_events, side_, segment, current_, candidate, after, missed);
  if (missed && halvings_ < hard_contact_steps::finest) return halve(arrived, "where an observable reaches its value could not be located");
  if (!seen.empty()) {
    const double there = seen.front().at_parameter;
    for (Event event : seen) {
      std::erase_if(event.at.point.state.hard, [](const HardForce& h) { return !(h.force > 0); });
      emit(event);
    }
    const Contacts slack = judge(seen.front().at, &current_).slack;
    accept(seen.front().at, slack, seen);
    for (const Event& event : seen)
      if (options_.user_events[event.user_event].stop) return end(Status::converged, fmt::format("{} reached at load factor {:.10g}", event.what, there));
    return;
  }
  if (std::abs(arrived - here) > hard_contact_steps::together * std::abs(options_.to - options_.from)) changes_ = 0;
  halvings_ = std::max(0, halvings_ - 1);
  if (std::any_of(judgement.slack.begin(), judgement.slack.end(), [&](const HardForce& h) { return !in(slack_, h); }))
    return kink(std::move(candidate), judgement.slack);
  tell(candidate.point);
  accept(std::move(candidate), judgement.slack);
}

// Where the first of the contacts that are wrong at the candidate changes, as far as straight lines tell.
std::optional<Equilibrium> HardContactSteps::first_change(const Contacts& wrong, const Equilibrium& candidate) {
  Energy& energy = newton_.energy();
  const State& from = current_.point.state;
  const double here = from.load_factor, way = candidate.point.state.load_factor - here;
  const HardForce* first = nullptr;
  double least = 1;
  for (const HardForce& h : wrong) {
    const double a = margin(h, current_), b = margin(h, candidate);
    if (const double part = a / (a - b); part < least) least = part, first = &h;
  }
  if (!first) return {};
  State state = from;
  energy.kinematics().prescribe(state, here + least * way);
  energy.kinematics().retract(state, energy.kinematics().difference(from, candidate.point.state), least);
  state.hard = closed_;
  for (HardForce& h : state.hard) h.force = (1 - least) * force_of(from, h) + least * force_of(candidate.point.state, h);
  const Report report = equilibrium_.meet(state, *first, newton_.tolerance(), &from, current_.zero_modes);
  const double part = (state.load_factor - here) / way;
  if (!report.converged() || !(part > 0 && part < 1) || energy.collision_free_step(from, state) < 1) return {};
  return assess(newton_, state, report);
}

// The rates at the beginning of a step did not tell that this contact changes there: it does, for the step shows it.
bool HardContactSteps::turn_back(const HardForce& contact) {
  if (++changes_ > hard_contact_steps::most_changes) return false;
  Contacts now = closed_;
  toggle(now, contact);
  change(current_, std::move(now), slack_);
  return true;
}

// An equilibrium at which contacts have neither gap nor force that had one before: which of them are closed behind? If no choice
// is right the stable branch ends here, and those that have come change sides.
void HardContactSteps::kink(Equilibrium at, const Contacts& slack) {
  if (++changes_ > hard_contact_steps::most_changes) {
    tell(at.point);
    accept(std::move(at), slack);
    const double here = current_.point.state.load_factor;
    const std::string why = "contacts change without end";
    if (options_.when_unstable == WhenUnstable::stop || interval_ == targets_.size())
      return end(Status::not_converged, fmt::format("the branch ends at load factor {:.10g}: {}", here, why));
    return snap(why, false);
  }
  std::optional<Contacts> now = equilibrium_.onward(at.point.state, slack, direction());
  if (!now) {
    now = closed_;
    for (const HardForce& h : slack)
      if (!in(slack_, h)) toggle(*now, h);
  }
  if (!same(*now, closed_)) return change(std::move(at), *now, slack);
  tell(at.point);
  accept(std::move(at), slack);
}

// An event where other contacts are closed from here on, and the branch behind it.
void HardContactSteps::change(Equilibrium at, Contacts now, const Contacts& slack) {
  const Model& model = newton_.energy().model();
  std::vector<std::string> sentences;
  for (const HardForce& h : slack)
    if (in(now, h) != in(closed_, h)) sentences.push_back(told(model, h, in(now, h)));
  sentences.erase(std::unique(sentences.begin(), sentences.end()), sentences.end());
  const int before = at.point.stability.negative;
  State state = at.point.state;
  state.hard = now;
  for (HardForce& h : state.hard) h.force = force_of(at.point.state, h);
  const double load = state.load_factor;
  Equilibrium behind = assess(newton_, state, at.point.report);
  const int after = behind.point.stability.negative;
  if (options_.contacts) {
    Event event;
    event.kind = EventKind::contact;
    for (std::size_t k = 0; k < std::min(hard_contact_steps::most_told, sentences.size()); ++k) event.what += (k ? ", " : "") + sentences[k];
    if (sentences.size() > hard_contact_steps::most_told) event.what += fmt::format(" and {} more", sentences.size() - hard_contact_steps::most_told);
    event.at = std::move(at);
    event.before = before, event.after = after;
    std::erase_if(event.at.point.state.hard, [&](const HardForce& h) { return !(h.force > 0) || in(slack, h); });
    emit(event);
  } else {
    tell(at.point);
  }
  closed_ = std::move(now);
  accept(std::move(behind), slack);
  if (after > before) {
    note(fmt::format("load factor {:.10g}: with the contacts, the number of negative eigenvalues goes from {} to {}", load, before, after));
    leave_unstable();
  }
}

// The equilibrium at which modes become critical, as an event: those whose eigenvalues vanish beside `scale`, of at most as many as change
// sign. `after`: the Morse index behind the last of them.
Event HardContactSteps::critical(Equilibrium at, EventKind kind, int after, double scale) {
  Event event;
  event.kind = kind;
  const int before = current_.point.stability.negative, sign = after > before ? 1 : -1, least = std::min(before, after), most = std::abs(after - before);
  const State& state = at.point.state;
  const int known = static_cast<int>(current_.zero_modes.cols());
  const EigenPairs lowest = equilibrium_.lowest(state, std::max(before, after) + known);
  std::vector<Eigen::Index> by_size;
  for (Eigen::Index j = 0; j < lowest.values.size(); ++j) {
    const Vector v = lowest.vectors.col(j);
    if (known == 0 || (current_.zero_modes.transpose() * v).norm() < 0.5) by_size.push_back(j);
  }
  std::sort(by_size.begin(), by_size.end(), [&](Eigen::Index i, Eigen::Index j) { return std::abs(lowest.values[i]) < std::abs(lowest.values[j]); });
  int count = 1;
  while (count < most && count < static_cast<int>(by_size.size()) && std::abs(lowest.values[by_size[static_cast<std::size_t>(count)]]) <= hard_contact_steps::vanishing * scale) ++count;
  event.modes.resize(lowest.vectors.rows(), std::min<Eigen::Index>(count, static_cast<Eigen::Index>(by_size.size())));
  for (Eigen::Index j = 0; j < event.modes.cols(); ++j) event.modes.col(j) = lowest.vectors.col(by_size[static_cast<std::size_t>(j)]);
  event.modes = canonical_modes(newton_.energy().kinematics(), event.modes);
  event.before = before, event.after = before + sign * count;
  at.zero_modes = current_.zero_modes;
  at.tangent = kind == EventKind::limit ? current_.tangent : equilibrium_.tangent(state, side_by_side(at.zero_modes, event.modes)).q;
  at.point.stability.stable = false;
  at.point.stability.negative = least;
  event.at_parameter = state.load_factor;
  event.at = std::move(at);
  return event;
}

// Where on the way to the candidate, which is on the same branch, an eigenvalue goes through zero: its mode keeps still along the branch, and held the
// equations are regular.
std::optional<Event> HardContactSteps::branch_point(Equilibrium candidate) {
  for (int k = 0; k < hard_contact_steps::most_crossings && !interrupted(); ++k) {
    const std::optional<Vanishing> found = crossing(candidate);
    if (!found) return {};
    // Another mode may have crossed zero before this one.
    const double here = current_.point.state.load_factor, beside = here + (1 - hard_contact_steps::just_before) * (found->at.point.state.load_factor - here);
    Equilibrium nearer = follow(current_, closed_, beside);
    if (!nearer.point.report.converged()) return {};
    if (nearer.point.stability.negative == current_.point.stability.negative) return critical(found->at, EventKind::branch, candidate.point.stability.negative, found->scale);
    candidate = std::move(nearer);
  }
  return {};
}

// Where the mode of the candidate that belongs to an eigenvalue of another sign does so.
std::optional<HardContactSteps::Vanishing> HardContactSteps::crossing(const Equilibrium& candidate) {
  Energy& energy = newton_.energy();
  const int before = current_.point.stability.negative, after = candidate.point.stability.negative;
  const EigenPairs lowest = equilibrium_.lowest(candidate.point.state, std::max(before, after));
  Vector mode = lowest.vectors.col(std::min<Eigen::Index>(std::min(before, after), lowest.vectors.cols() - 1));
  const Eigen::MatrixXd& known = current_.zero_modes;
  if (known.cols() > 0) mode -= known * (known.transpose() * mode);
  if (!(mode.norm() > 0.5)) return {};
  mode.normalize();
  const auto sample = [&](const Equilibrium& e) { return Sample{e.point.state.load_factor, equilibrium_.curvature(e.point.state, mode, known), e}; };
  const Sample lower = sample(current_), upper = sample(candidate);
  if (!((lower.f < 0) != (upper.f < 0)) || !std::isfinite(lower.f) || !std::isfinite(upper.f)) return {};
  const Eigen::MatrixXd held = side_by_side(known, mode);
  const auto resolution = [&](double) { return segment::rounding * std::abs(upper.t - lower.t); };
  const auto zero = find_zero(lower, upper, resolution, [&](double t, const Sample& near) -> std::optional<Sample> {
    State state = near.e.point.state;
    const double way = t - state.load_factor, whole = upper.t - lower.t;
    energy.kinematics().prescribe(state, t);
    energy.kinematics().retract(state, energy.kinematics().difference(current_.point.state, candidate.point.state), way / whole);
    state.hard = closed_;
    for (HardForce& h : state.hard) h.force = force_of(near.e.point.state, h);
    State free = state;
    Report report = equilibrium_.settle(state, newton_.tolerance(), &near.e.point.state, ContactEquilibrium::anywhere, held);
    if (!report.converged()) {                                  // a force is left along the mode: it moves, with the load factor
      state = free;
      report = equilibrium_.settle(state, newton_.tolerance(), &near.e.point.state, ContactEquilibrium::anywhere, known);
    }
    if (!report.converged()) return {};
    Equilibrium e;
    e.point.state = state, e.point.report = report;
    return sample(e);
  });
  const double scale = std::max(std::abs(lower.f), std::abs(upper.f));
  if (!zero || !(std::abs(zero->f) <= vanished_below(scale, equilibrium_.zero_level()))) return {};
  return Vanishing{assess(newton_, zero->e.point.state, zero->e.point.report), scale};
}

// Where the load factor turns, ahead within a few steps: the equilibria along the softest motion, of which the load factor is a parabola.
std::optional<Event> HardContactSteps::limit_point(double target) {
  Energy& energy = newton_.energy();
  const State& origin = current_.point.state;
  const double here = origin.load_factor;
  const Eigen::MatrixXd& known = current_.zero_modes;
  const int before = current_.point.stability.negative;
  Vector mode = current_.tangent;                               // it turns into the critical mode
  if (known.cols() > 0) mode -= known * (known.transpose() * mode);
  if (!(mode.norm() > 0) || !mode.allFinite()) return {};
  mode.normalize();
  State state = origin;
  double slope = 0;
  if (!equilibrium_.slide(state, origin, mode, 0, newton_.tolerance(), known, slope).converged()) return {};
  const double forward = target < here ? -1 : 1, a_little = 0.1 / std::max(movement(energy, mode), 1e-300);
  const bool there = !(slope * a_little > hard_contact_steps::at_the_limit * std::abs(target - here));                 // or all but
  double a = 0, slope_a = slope, b = forward * (there ? 0.1 * a_little : std::min(std::abs(target - here) / slope, a_little));
  double steepest = std::abs(slope);
  State found = state;
  for (int k = 0; k < hard_contact_steps::most_along && !interrupted(); ++k) {      // the secant of dλ/ds
    State next = found;
    energy.kinematics().retract(next, mode, b - a);
    double slope_b = 0;
    const Report report = equilibrium_.slide(next, origin, mode, b, newton_.tolerance(), known, slope_b);
    if (!report.converged() || energy.collision_free_step(origin, next) < 1) return {};
    // The branch turns little on the way, or the step is too long to tell this branch from another one.
    if (energy.kinematics().difference(origin, next).norm() > hard_contact_steps::turns_little * std::abs(b)) return {};
    // On this branch one more eigenvalue is negative behind the limit point, and none before it.
    if (!there && std::abs(slope_b) > 1e-3 * slope && equilibrium_.inertia(next).negative != before + (slope_b < 0 ? 1 : 0)) return {};
    steepest = std::max(steepest, std::abs(slope_b));
    found = next;
    const double step = -slope_b * (b - a) / (slope_b - slope_a);
    if (std::abs(slope_b) <= hard_contact_steps::vanished * steepest) {
      const double part = (next.load_factor - here) / (target - here);
      if (!(part >= -hard_contact_steps::at_the_limit && part <= 1)) return {};
      Equilibrium at = assess(newton_, next, report);
      at.tangent = current_.tangent;
      if (!judge(at, nullptr).wrong.empty()) return {};         // contacts change before
      return critical(std::move(at), EventKind::limit, before + 1, 0);
    }
    if (!std::isfinite(step)) return {};
    a = b, slope_a = slope_b;
    b += std::clamp(step, -4 * std::abs(b), 4 * std::abs(b));
  }
  return {};
}

// An event of stability: the branch ends there, or goes on.
void HardContactSteps::lose(Event event) {
  const bool limit = event.kind == EventKind::limit;
  const Equilibrium whole = event.at;
  if (limit ? options_.limits : options_.branch_points) {
    std::erase_if(event.at.point.state.hard, [](const HardForce& h) { return !(h.force > 0); });
    emit(event);
  }
  const double at = event.at.point.state.load_factor;
  const std::string label = event.at.point.label.empty() ? "the loss of stability" : event.at.point.label;
  const bool loses = event.after > event.before;
  if (loses && options_.when_unstable == WhenUnstable::stop)
    return end(Status::converged, fmt::format("stopped at {}, load factor {:.10g}", label, at));
  if (limit && options_.when_unstable == WhenUnstable::follow)
    return end(Status::not_converged, fmt::format("{} at load factor {:.10g}: load steps cannot follow the branch beyond", label, at));
  accept(whole, judge(whole, &current_).slack);
  if (limit || (loses && options_.when_unstable == WhenUnstable::jump)) {
    if (interval_ < targets_.size()) snap("stability is lost", true);
    return;
  }
  current_.point.stability.negative = event.after;
}

// Stability changes on the way to this load factor, and where could not be told: closer, until the step is the finest; then it is a note.
void HardContactSteps::miss(double target, int after) {
  const double here = current_.point.state.load_factor;
  const int before = current_.point.stability.negative;
  if (halvings_ < hard_contact_steps::finest) return halve(target, "stability changes");
  note(fmt::format("between load factors {:.10g} and {:.10g} the number of negative eigenvalues goes from {} to {}: a branch point or a "
                   "limit point, not located further", here, target, before, after));
  current_.point.stability.negative = after;
  if (after > before) leave_unstable();
}

void HardContactSteps::leave_unstable() {
  if (options_.when_unstable == WhenUnstable::stop)
    return end(Status::converged, fmt::format("stopped where stability is lost, load factor {:.10g}", current_.point.state.load_factor));
  if (options_.when_unstable == WhenUnstable::jump && interval_ < targets_.size()) snap("stability is lost", true);
}

void HardContactSteps::halve(double target, const std::string& why) {
  if (interrupted()) return end(Status::interrupted, "interrupted");
  if (halvings_++ < hard_contact_steps::finest) return;
  const double here = current_.point.state.load_factor;
  note(fmt::format("load factor {:.10g} could not be passed in steps of {:.3g}: {}", here, std::abs(target - here), why));
  if (options_.when_unstable == WhenUnstable::stop)
    return end(Status::not_converged, fmt::format("the branch ends at load factor {:.10g}: {}", here, why));
  snap(why, false);
}

// A little farther on, the minimum that Ipopt finds from here. Where the branch goes on, unstable, it is left to both sides of its
// critical mode, and the lower of two minima is taken; of two that are alike always the same, so that rounding does not choose.
void HardContactSteps::snap(const std::string& why, bool stability_lost) {
  Energy& energy = newton_.energy();
  const Kinematics& kinematics = energy.kinematics();
  const double here = current_.point.state.load_factor, past = snap_begins(options_, here, continuation::snap_beyond.front());
  const auto ends = [&](Status status, const std::string& sentence) {
    end(status, fmt::format("the branch ends at load factor {:.10g}{}", here, sentence));
  };
  if (std::abs(past - here) <= 1e-9 * std::abs(options_.to - options_.from)) return ends(Status::not_converged, ": " + why);
  State state = current_.point.state;
  kinematics.prescribe(state, past);
  if (energy.collision_free_step(current_.point.state, state) < 1) return ends(Status::not_converged, ": " + why);
  if (current_.tangent.allFinite()) {
    State predicted = state;
    kinematics.retract(predicted, current_.tangent, past - here);
    if (energy.collision_free_step(current_.point.state, predicted) == 1 && movement(energy, current_.tangent) * std::abs(past - here) < 1) state = predicted;
  }
  std::vector<State> starts;
  if (const Equilibrium on = follow(current_, closed_, past);
      on.point.report.converged() && on.point.stability.negative > 0 && judge(on, nullptr).wrong.empty()) {
    state = on.point.state;
    const Vector mode = canonical_modes(kinematics, equilibrium_.lowest(state, 1).vectors).col(0);
    const double part = std::min(hard_contact_steps::aside / std::max(distortion(energy, state, mode), 1e-300), hard_contact_steps::aside / std::max(movement(energy, mode), 1e-300));
    for (const double side : {-1.0, 1.0}) {
      starts.push_back(state);
      kinematics.retract(starts.back(), mode, side * part);
    }
  } else {
    starts.push_back(state);
  }
  const double before = energy.value(state);
  Report report;
  double lowest = std::numeric_limits<double>::infinity();
  for (State& from : starts) {
    const Report found = minimise(newton_, from, IpoptOptions{.tolerance = newton_.tolerance(), .barrier = hard_contact_steps::nearest});
    if (found.converged() ? !(found.energy < lowest - hard_contact_steps::alike * std::abs(before - lowest)) && report.converged() : report.converged()) continue;
    report = found;
    if (found.converged()) state = from, lowest = found.energy;
  }
  if (!report.converged()) return ends(report.status, "; Ipopt finds no minimum beyond: " + report.why);
  Equilibrium landed = assess(newton_, state, report);
  const std::string what = fmt::format("from energy {:.10g} to {:.10g} at load factor {:.10g}", before, report.energy, past);
  if (!stability_lost && same_branch(energy, current_, landed)) {
    tell(landed.point);                                         // only the steps were too hard
  } else {
    note(fmt::format("jump: {}", what));
    emit_landing(landed.point, what, current_.point.stability.negative, "");
  }
  go_on(std::move(landed));
}

}  // namespace elamin
