#include "path/branch.hpp"

#include "core/factor_counts.hpp"
#include "path/event_error.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/locate.hpp"
#include "solve/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace elamin {

using namespace limits;

constexpr const char* lower_before = "what lies beyond has a lower energy where the step begins: it is on another branch";

Branch::Branch(Newton& newton, Departure from, bool contacts, bool event_errors, std::vector<UserEvent> user_events)
    : newton_(newton), current_(std::move(from.at)), negative_(from.negative), singular_(from.singular || from.negative < 0),
      at_contact_(from.at_contact), closed_(std::move(from.closed)), changed_(std::move(from.changed)), contacts_(contacts), event_errors_(event_errors),
      user_events_(std::move(user_events)), side_(std::move(from.sides)) {
  for (std::size_t k = side_.size(); k < user_events_.size(); ++k) side_.push_back(user_events_[k].side(current_.point.state));
  newton_.factors().expect(negative_ > 0, current_.soft);
}

void Branch::carry(Archive& archive) {
  archive(current_, negative_, sign_, neutral_, singular_, at_contact_, closed_, changed_, side_, searches_, soft_before_, load_before_, status_, why_);
}

const Event* Branch::deciding(const Candidate& c) {
  return c.events.empty() || c.events.front().kind == EventKind::user ? nullptr : &c.events.front();
}

std::optional<Branch::Candidate> Branch::reach_load(const Equilibrium& from, double target, std::string& why, const Corrector& correct) {
  std::optional<Candidate> c = corrected(from, target, why, correct);
  return c ? with_events(std::move(*c), why) : std::nullopt;
}

std::optional<Branch::Candidate> Branch::corrected(const Equilibrium& from, double target, std::string& why, const Corrector& correct) {
  Equilibrium e = continue_to(newton_, from, target, correct);
  if (e.point.report.status == Status::interrupted) stop_here(Status::interrupted, "interrupted");
  if (!e.point.report.converged()) return why = e.point.report.why, std::nullopt;
  if (from.pushed && e.point.stability.negative > negative_) return why = "what was pushed is caught", std::nullopt;
  if (searches() && !e.slack && e.point.stability.negative == 0) {
    e.soft_values = newton_.factors().soft_values(std::min(equilibrium::softest, newton_.energy().dofs()));
    if (softens()) see_softest(newton_, e, current_.softest, branch::little * (from.point.state.load_factor - target));
  }
  return Candidate{.parameter = target, .e = std::move(e), .natural = true};
}

std::optional<Branch::Candidate> Branch::with_events(Candidate c, std::string& why) {
  const Segment segment = beside(segment_of_loads(newton_, current_.point.state.load_factor, c.parameter), c);
  if (!find_events(segment, c, why)) return {};
  return c;
}

Equilibrium Branch::past_contact(double way) {
  for (double part = 1; part >= branch::least_past; part /= 16) {
    const Equilibrium e = continue_to(newton_, current_, current_.point.state.load_factor + sign_ * part * way);
    if (!e.point.report.converged() || e.point.stability.negative != negative_ || e.point.stability.critical > 0) continue;
    if (closed_contacts(newton_.energy(), e) != closed_) continue;
    Equilibrium past = current_;
    past.tangent = e.tangent, past.pushed |= e.pushed;
    return past;
  }
  return current_;
}

Segment Branch::beside(Segment segment, const Candidate& c) const {
  segment.at = [this, at = std::move(segment.at), end = c.e.point.state](double t, const Equilibrium& nearest) {
    Equilibrium e = at(t, nearest);
    if (e.point.report.converged() && !beside_chord(newton_.energy().kinematics(), current_.point.state, end, e.point.state))
      e.point.report.status = Status::not_converged, e.point.report.why = "the corrector went to another branch";
    return e;
  };
  return segment;
}

Branch::Candidate Branch::with_contact(Candidate c, ContactChange change) const {
  Event event;
  event.kind = EventKind::contact;
  event.before = negative_;                                     // after: when it is known that nothing comes before
  event.closed = std::move(change.after), event.what = std::move(change.what);
  event.beyond = std::move(change.beyond), event.onward = change.onward;
  event.at_parameter = c.parameter;
  c.e = std::move(change.at);
  const double width = c.e.point.state.load_factor - current_.point.state.load_factor;
  if (event_errors_ && sharpen(newton_, c.e)) c.e.point.load_error = contact_error(newton_, c.e, difference(event.closed, closed_), width);
  event.at = c.e;
  c.events = {std::move(event)};
  return c;
}

// Whether contacts that have changed here change back at this very place: by rounding, which leads nowhere.
bool Branch::undoes(const ContactChange& change) const {
  const ContactSet keys = difference(change.after, closed_);
  if (keys.empty() || !std::all_of(keys.begin(), keys.end(), [&](const ContactKey& key) { return changed_.count(key) > 0; })) return false;
  const Kinematics& kinematics = newton_.energy().kinematics();
  const State &from = current_.point.state, &to = change.at.point.state;
  const double moved = kinematics.difference(from, to).lpNorm<Eigen::Infinity>(), load = std::max(std::abs(from.load_factor), std::abs(to.load_factor));
  return moved <= contact_event::together * kinematics.smallest_size() && std::abs(to.load_factor - from.load_factor) <= contact_event::same_load * load;
}

// The candidate is where a contact is made, or lost, which is as it was again where the step ends.
bool Branch::stop_where_contact_passes(const Segment& segment, Candidate& c) {
  const std::optional<double> where = where_contact_may_pass(newton_.energy(), segment, current_, c.e, changed_);
  if (!where) return false;
  Equilibrium e = segment.at(*where, current_);
  if (!e.point.report.converged() || closed_contacts(newton_.energy(), e) == closed_) return false;
  c.parameter = *where, c.e = std::move(e);
  return true;
}

// Looks between the ends of a step where `where` tells, up to a few times nearer, for a state that is `wanted`: then the candidate becomes that. Nothing if no equilibrium
// is found where it is to be looked for.
std::optional<bool> Branch::look_between(const Segment& segment, Candidate& c, const Where& where, const std::function<bool(Equilibrium&)>& wanted) const {
  double ta = segment.a, tb = segment.b;
  Equilibrium a = current_, b = c.e;
  std::optional<Place> next = where(ta, a, tb, b);
  for (int k = 0; next && k < branch::most_looks; ++k) {
    const double t = next->t;
    Equilibrium e = segment.at(t, a);
    if (!e.point.report.converged()) return {};
    if (wanted(e)) return c.parameter = t, c.e = std::move(e), c.events.clear(), true;
    const std::optional<Place> before = where(ta, a, t, e), behind = where(t, e, tb, b);
    const bool first = before && (!behind || before->by <= behind->by);
    (first ? tb : ta) = t, (first ? b : a) = std::move(e);
    next = first ? before : behind;
  }
  return false;
}

// Where the load factor goes back between the ends of a step, at both of which it goes on, two limit points lie between: the candidate becomes a state between
// them. It is looked for where Hermite's cubic of λ has its least rate, if that is little beside the rates at both ends:
//   λ' = ra + 2u (3Δλ − 2ra − rb) + 3u² (ra + rb − 2Δλ)
// False if it went back over the whole step, which proves two limit points, and none was found.
bool Branch::stop_where_load_goes_back(const Segment& segment, Candidate& c) {
  const auto slowest = [&](double ta, const Equilibrium& a, double tb, const Equilibrium& b) -> std::optional<Place> {
    const double width = tb - ta, ra = singular_ && ta == segment.a ? 0.0 : width * segment.load_rate(a), rb = width * segment.load_rate(b);
    const double change = b.point.state.load_factor - a.point.state.load_factor;
    const double h = 3 * change - 2 * ra - rb, k = ra + rb - 2 * change, u = -h / (3 * k);
    const double by = std::copysign(1.0, rb) * (ra + u * h) / std::min(std::abs(ra), std::abs(rb));      // where the rate is least h + 3uk = 0
    if (!(u > 0 && u < 1 && by < branch::slowed)) return {};
    return Place{ta + u * width, by};
  };
  return look_between(segment, c, slowest, [&](Equilibrium& e) { return segment.load_rate(e) * sign_ < 0; }).value_or(false) || !goes_back(c);
}

// Whether the load factor has gone back from here, by more than rounding.
bool Branch::goes_back(const Candidate& c) const {
  const double here = current_.point.state.load_factor;
  return sign_ * (here - c.e.point.state.load_factor) > branch::load_rounding * std::abs(here);
}

// Whether a stable state is on this branch, which is stable, too. On a stable branch the load factor goes on all the way, det H > 0 on both sides of each contact: what is
// at the same load factor, but for rounding δλ, is no farther than the tangents tell, |Δx| ~ |dx/dλ| δλ. Beyond a branch point lies its other half, its mirror image.
bool Branch::goes_on(const Candidate& c) const {
  const Kinematics& kinematics = newton_.energy().kinematics();
  const double here = current_.point.state.load_factor, rounding = branch::load_rounding * std::abs(here);
  if (sign_ * (c.e.point.state.load_factor - here) > rounding) return true;
  const double told = branch::most_told * rounding * std::max(current_.tangent.norm(), c.e.tangent.norm());
  return !goes_back(c) && kinematics.difference(current_.point.state, c.e.point.state).norm() <= told + contact_event::together * kinematics.smallest_size();
}

// Whether the load factor goes on as before behind contacts of particles that change at the candidate: their gaps tell it, which go to their other side. By its direction, which
// may be all but square to that of the step there, the load factor may as well go back.
bool Branch::goes_on_behind(const Candidate& c) const {
  const Event* event = deciding(c);
  if (!event || event->kind != EventKind::contact || event->beyond) return false;
  const ContactSet changed = difference(event->closed, closed_);
  const double here = c.e.point.state.load_factor, width = std::max(std::abs(here - current_.point.state.load_factor), std::cbrt(epsilon) * std::abs(here));
  return !changed.empty() && std::all_of(changed.begin(), changed.end(), [&](const ContactKey& key) {
    Vector row;
    double by_load = 0;
    if (key.feature >= 0 || !slope(newton_.energy(), key, c.e.point.state, width, row, by_load)) return false;
    return (event->closed.count(key) ? -sign_ : sign_) * (row.dot(c.e.tangent) + by_load) > 0;
  });
}

// Whether an eigenvalue may vanish twice, or two of them in opposite ways, on the step from here: on the step before, which was half as long or longer, |μ| has then
// fallen by a factor of 1.5 (a straight line with its zero at the end of this step) or more (2.25: a parabola).
bool Branch::softens() const {
  const Vector &before = soft_before_, &here = current_.soft_values;
  return before.size() == 0 || here.size() != before.size() || (here.array() * branch::softened < before.array()).any();
}

// How far ahead a limit point is, if the softest eigenvalue goes on as on the last step:  μ² ∝ λ_c − λ. Infinite where nothing has softened.
double Branch::way_to_limit() const {
  const Vector &before = soft_before_, &here = current_.soft_values;
  if (before.size() == 0 || here.size() != before.size() || !(here.minCoeff() < before.minCoeff())) return infinity;
  const double left = here.minCoeff() * here.minCoeff(), lost = before.minCoeff() * before.minCoeff() - left;
  return left / lost * std::abs(current_.point.state.load_factor - load_before_);
}

void Branch::see_softest_anew(Equilibrium& e, const EigenPairs& neighbour, double change) {
  newton_.energy().evaluate(e.point.state);
  newton_.factors().factorize_holding(e.zero_modes);
  see_softest(newton_, e, neighbour, change);
}

// Behind an event, or where the branch begins, or where nothing has softened yet.
void Branch::see_softest_here(const Candidate& c, double change) {
  if (current_.softest.values.size() > 0 || c.e.softest.values.size() == 0) return;
  see_softest_anew(current_, c.e.softest, change);
  Vector& values = current_.softest.values;
  if (singular_) values = (values.array().abs() <= branch::vanished * infinity_norm(values)).select(0, values);
}

namespace {

struct Part { double u, by; };       // of a step, and how likely: the less the more

// Where on a step, from a to b, the softest eigenvalues make another index than at the end that is nearer, in the middle of where first: of modes that are alike at both
// ends by Hermite's cubics, of others by the tangent up to the middle of the step; or where a cubic is least beside its values at both ends, if that is little.
// la, lb: rates of the load factor at both ends, per step.
std::optional<Part> where_index_differs(const Equilibrium& a, const Equilibrium& b, double la, double lb) {
  if (a.softest.values.size() == 0 || b.softest.values.size() == 0) return {};
  constexpr int half = branch::samples / 2;
  std::array<int, branch::samples> more{};                      // negative ones than at the nearer end
  Part least{0, branch::slowed};
  const Eigen::MatrixXd alike = (a.softest.vectors.transpose() * b.softest.vectors).cwiseAbs();
  Eigen::ArrayX<bool> alone = Eigen::ArrayX<bool>::Constant(alike.cols(), true);
  for (Eigen::Index i = 0; i < alike.rows(); ++i) {
    Eigen::Index j = 0;
    const bool stays = alike.row(i).maxCoeff(&j) >= branch::same_mode;
    if (stays) alone[j] = false;
    const double from = a.softest.values[i], ra = la * a.softening[i], to = b.softest.values[j], rb = lb * b.softening[j];
    for (int k = 1; k < (stays ? branch::samples : half); ++k) {
      const double u = static_cast<double>(k) / branch::samples, v = 1 - u;
      const double value = stays ? v * v * ((1 + 2 * u) * from + u * ra) + u * u * ((3 - 2 * u) * to - v * rb) : from + u * ra;
      const double end = k >= half ? to : from != 0 ? from : ra;
      more[k] += (value < 0) - (end < 0);
      const double by = std::copysign(1.0, from) * value / std::min(std::abs(from), std::abs(to));
      if (stays && from * to > 0 && by < least.by) least = {u, by};
    }
  }
  for (Eigen::Index j = 0; j < alike.cols(); ++j)
    for (int k = half; k < branch::samples && alone[j]; ++k) {
      const double to = b.softest.values[j], v = 1 - static_cast<double>(k) / branch::samples;
      more[k] += (to - v * lb * b.softening[j] < 0) - (to < 0);
    }
  const auto first = std::find_if(more.begin() + 1, more.end(), [](int n) { return n != 0; }), last = std::find(first, more.end(), 0);
  if (first != more.end()) return Part{static_cast<double>(first - more.begin() + last - more.begin() - 1) / (2 * branch::samples), -1};
  if (least.by < branch::slowed) return least;
  return {};
}

}  // namespace

// Where an eigenvalue changes its sign twice between the ends of a step, or two of them in opposite ways, two branch points lie between that the Morse index does
// not tell at the ends: the candidate becomes a state between them. False if no equilibrium is found there: the branch does not lead straight from the one end to the other.
bool Branch::stop_where_index_goes_back(const Segment& segment, Candidate& c) {
  const double little = branch::little * (segment.b - segment.a);
  const auto look_at = [&](Equilibrium& e, const Equilibrium& neighbour) { see_softest(newton_, e, neighbour.softest, little * segment.load_rate(e)); };
  if (!c.events.empty() && softens()) see_softest_anew(c.e, current_.softest, -little * segment.load_rate(c.e));      // from this side of the contact
  see_softest_here(c, little * segment.load_rate(current_));
  const auto softest = [&](double ta, const Equilibrium& a, double tb, const Equilibrium& b) -> std::optional<Place> {
    const double width = tb - ta;
    const std::optional<Part> part = where_index_differs(a, b, width * segment.load_rate(a), width * segment.load_rate(b));
    return part ? std::optional(Place{ta + part->u * width, part->by}) : std::nullopt;
  };
  const Eigen::Index neutral = std::min(current_.zero_modes.cols(), c.e.zero_modes.cols());      // of what is held at both ends the sign is rounding's
  return look_between(segment, c, softest, [&](Equilibrium& e) {
    if (std::abs(e.point.stability.negative - negative_) > std::max<Eigen::Index>(0, neutral - e.zero_modes.cols())) return true;
    return look_at(e, current_), false;
  }).has_value();
}

// An unstable branch may become stable at a limit point or branch point, and unstable again where a contact is lost, whose stiffness vanishes there. Then the Morse index is the
// same at both ends of the step. This is the state shortly before the contact is lost, if its index is another one; else nothing.
std::optional<Branch::Candidate> Branch::before_it_leaves(const Along& at, double from, double where, const ContactSet& after) const {
  if (negative_ <= 0 || current_.slack || std::includes(after.begin(), after.end(), closed_.begin(), closed_.end())) return {};
  const double before = from + branch::before_contact * (where - from);
  Equilibrium e = at(before, current_);
  if (!e.point.report.converged() || e.point.stability.negative == negative_) return {};
  return Candidate{.parameter = before, .e = std::move(e)};
}

// Whether contacts are closed, or open, at a change that is none of theirs, and were not where the step begins. There what has just changed has next to no gap.
bool Branch::changes_before(const ContactChange& change) {
  Energy& energy = newton_.energy();
  ContactSet others = difference(closed_contacts(energy, change.at), change.after);
  for (const ContactKey& key : difference(change.after, closed_)) others.erase(key);
  const ContactSet here = closed_contacts(energy, current_);
  return std::any_of(others.begin(), others.end(), [&](const ContactKey& key) {
    return (here.count(key) > 0) == (change.after.count(key) > 0) || !just_touches(energy, key, change.at.point.state);
  });
}

bool Branch::contact_may_explain(const Candidate& c) const { return c.e.point.stability.negative != negative_ && may_touch(newton_.energy().model()); }

// Contacts that nobody asks for are located only where no limit point and no branch point explains why the Morse index changes.
bool Branch::find_events(const Segment& segment, Candidate& c, std::string& why) {
  const CountFor events(FactorsFor::events);
  if (!searches()) {
    if (c.e.point.stability.negative != negative_) return why = "the Morse index changes", false;
    if (lower_already(newton_.energy(), current_, c.e)) return why = lower_before, false;
    return find_user_events(segment, c, why);
  }
  std::optional<Candidate> critical;
  if (!contacts_ && !current_.slack && contact_may_explain(c)) critical = c;
  if (critical && find_critical(segment, *critical, why)) c = std::move(*critical);
  else if (!find_contact(segment, c, why) || (critical && c.events.empty()) || !find_critical(segment, c, why)) return false;      // a search that has failed would fail again
  return find_user_events(segment, c, why);
}

bool Branch::find_contact(Segment segment, Candidate& c, std::string& why) {
  // Not looked for unless asked, or where something floats and may be caught, or where one may explain why the Morse index changes.
  if (!contacts_ && !current_.slack && !contact_may_explain(c)) return true;
  const bool passes = contacts_ && !current_.slack && stop_where_contact_passes(segment, c);
  segment.b = c.parameter;
  std::optional<ContactChange> change = locate_contact(newton_, segment, closed_, current_, c.e);
  while (change && change->found && !current_.slack && changes_before(*change)) {        // what is as it was at the end of the step
    segment.b = change->at_parameter;
    std::optional<ContactChange> earlier = locate_contact(newton_, segment, closed_, current_, change->at);
    if (!earlier || !(std::abs(earlier->at_parameter - segment.a) < (1 - contact_event::together_in_step) * std::abs(segment.b - segment.a))) break;
    change = std::move(earlier);
  }
  // What changes at the end of the step may hide another contact that is made and lost before.
  if (contacts_ && !current_.slack && change && change->found) {
    Candidate before{.parameter = change->at_parameter, .e = change->at};
    segment.b = before.parameter;
    if (stop_where_contact_passes(segment, before)) {
      segment.b = before.parameter;
      if (std::optional<ContactChange> first = locate_contact(newton_, segment, closed_, current_, before.e)) change = std::move(first);
    }
  }
  if (!change && !passes) return true;
  if (!change || !change->found) return why = "a contact that is made or lost could not be located", false;
  c.parameter = change->at_parameter;
  if (undoes(*change)) return why = "a contact that has just changed changes back where it is", false;
  if (std::optional<Candidate> earlier = before_it_leaves(segment.at, segment.a, c.parameter, change->after)) {
    earlier->natural = c.natural;
    return c = std::move(*earlier), true;
  }
  const double way = c.e.point.state.load_factor - current_.point.state.load_factor;
  c = with_contact(std::move(c), std::move(*change));
  if (current_.slack) look_behind(c.events.front(), way);
  if (c.natural && !same_branch(newton_.energy(), current_, c.e)) return why = "the corrector went to another branch", false;
  return true;
}

// What has floated may be caught there: an equilibrium a little farther tells.
void Branch::look_behind(Event& contact, double way) {
  const State& here = contact.at.point.state;
  for (double part = branch::first_past; part >= branch::least_past && !contact.beyond; part /= 16) {
    Equilibrium e = continue_to(newton_, contact.at, here.load_factor + part * way);
    if (!e.point.report.converged()) continue;
    e.point.state = here, e.point.energy = contact.at.point.energy, e.point.report = contact.at.point.report;
    contact.beyond = std::move(e), contact.onward = sign_;
  }
}

// What was neutral may have a sign behind a contact, or a force: a column that may bend in any direction slides along the wall that it has come to.
void Branch::see_neutral_behind(Event& contact, double way) {
  Equilibrium from = contact.at;
  hold_family(newton_, from, current_.family, current_.zero_modes);
  contact.slides = from.zero_modes.cols() > 0 && opens_along(newton_.energy(), from, difference(contact.closed, closed_));
  if (contact.slides) return;
  for (double part = branch::first_past; part <= branch::last_past; part *= 16) {
    const Equilibrium e = continue_to(newton_, from, from.point.state.load_factor + part * way);
    if (!e.point.report.converged()) return void(contact.slides = true);         // what is held is pushed along
    if (e.zero_modes.cols() == from.zero_modes.cols()) continue;
    contact.after = e.point.stability.negative;
    if (contact.after > contact.before) contact.modes = from.zero_modes;
    return;
  }
}

// Branch points and limit points: where the Morse index changes, and where the load factor turns though it does not.
bool Branch::find_critical(Segment segment, Candidate& c, std::string& why) {
  segment.b = c.parameter;
  const auto rises = [&](const Equilibrium& e) { return segment.load_rate(e) >= 0 ? 1 : -1; };
  const bool kink = !c.events.empty() && c.events.front().beyond;               // it may be where the branch stands
  const auto goes_on_alike = [&] { return !c.natural && !c.stands && !kink && c.e.point.stability.negative == negative_ && rises(c.e) == sign_; };
  if (goes_on_alike() && !stop_where_load_goes_back(segment, c)) return why = "the load factor goes back between two states at which it goes on", false;
  segment.b = c.parameter;
  if (goes_on_alike() && !stop_where_index_goes_back(segment, c))
    return why = "no equilibrium was found on the step where an eigenvalue may vanish", false;
  segment.b = c.parameter;
  const int after = c.e.point.stability.negative;
  const bool stays_stable = !c.events.empty() && negative_ == 0 && after == 0;      // up to a contact, behind which the tangent may be any other one
  if (stays_stable && !current_.slack && !goes_on(c)) return why = "the load factor does not go on between two stable states: the contact is on another branch", false;
  const bool turns = !c.natural && !stays_stable && rises(c.e) != sign_ && !(after == negative_ && goes_on_behind(c));
  if (after == negative_ && !turns) {
    if (negative_ == 0 && lower_already(newton_.energy(), current_, c.e))
      return why = lower_before, false;
    if (c.events.empty()) return true;
    Event& contact = c.events.front();
    contact.after = contact.beyond ? contact.beyond->point.stability.negative : after;
    if (!contact.beyond && current_.family > 0) see_neutral_behind(contact, c.e.point.state.load_factor - current_.point.state.load_factor);
    if (contact.beyond && contact.onward == -sign_) contact.kind = EventKind::limit;
    return true;
  }
  // What was neutral to rounding, and held, turns out to have a sign: no event.
  const Eigen::Index resolved = current_.zero_modes.cols() - c.e.zero_modes.cols();
  if (!turns && c.events.empty() && neutral_.cols() > 0 && resolved > 0 && std::abs(after - negative_) <= resolved) return true;
  std::optional<Event> event;
  if (after != negative_) {
    event = locate_crossing(newton_, segment, current_, negative_, c.e, c.natural ? std::nullopt : std::optional(turns));
    if (event && !explained(*event, segment, c)) event.reset();
  }
  // Where a side branch arrives at a double branch point the other mode may have another sign on its other half, as of a structure of odd symmetry.
  if (!event && turns && rises(current_) == sign_) {
    event = locate_arrival(newton_, segment, current_, c.e, segment.load_rate);
    if (event && after != negative_ && event->modes.cols() < 2) event.reset();
  }
  if (!event || event->modes.cols() == 0)
    return why = "the Morse index changes, but there is no limit point and no branch point between: two branches pass by each other", false;
  const double width = c.e.point.state.load_factor - current_.point.state.load_factor;
  if (event_errors_)
    event->at.point.load_error = event->kind == EventKind::limit ? limit_error(newton_, event->at, event->modes)
                                                                 : branch_error(newton_, event->at, event->modes, width);
  c.parameter = event->at_parameter, c.e = event->at;
  c.events = {std::move(*event)};
  return true;
}

// From the event the branch leads to both ends of the step. A limit point that leads back to where the step begins is on this branch, whatever lies beyond; one that
// leads to the other end alone may be that of another branch, as beside a pitchfork that is all but perfect, where both have the same index. No step of the load
// factor meets a limit point.
bool Branch::explained(const Event& event, const Segment& segment, const Candidate& c) const {
  const auto leads_to = [&](const Equilibrium& end) { return segment.leads(event.at, end); };
  if (event.kind == EventKind::limit) return !c.natural && leads_to(singular_ ? c.e : current_) && turns_back(event);
  return leads_to(c.e) && (singular_ || leads_to(current_));
}

// At a limit point the load factor turns back from where it has been going:  λ'' = −vᵀ∇³E v v/(vᵀ∂g/∂λ) has the opposite sign of dλ/ds before it. Beside a pitchfork that
// is all but perfect the other branch has one that opens onward. Told by what is closed there staying so, by a part of every overlap at most; not where bodies touch, whose
// stiffness changes at once, or where rounding hides it.
bool Branch::turns_back(const Event& event) const {
  Energy& energy = newton_.energy();
  const Kinematics& kinematics = energy.kinematics();
  const State& here = event.at.point.state;
  const Vector v = event.modes.col(0);
  double way = branch::to_see_turn * std::abs(v.dot(kinematics.difference(current_.point.state, here)));
  const ContactSet closed = closed_contacts(energy, here);
  const auto aside = [&](int side) { return moved_by(kinematics, here, v, 0, side ? way : -way); };
  double most = 0;                                              // of the parts by which overlaps change
  for (const ContactKey& key : closed) {
    if (key.feature >= 0) return true;
    const double overlap = gap(energy, key, here);
    for (const int side : {0, 1}) most = std::max(most, std::abs(gap(energy, key, aside(side)) / overlap - 1));
  }
  if (most > branch::same_overlap) way *= branch::same_overlap / most;
  double stiffness[2], rounding = 0;
  for (const int side : {0, 1}) {
    const State beside = aside(side);
    if (closed_contacts(energy, beside) != closed) return true;
    energy.evaluate(beside);
    const BilinearForm form = energy.form(v, v);
    stiffness[side] = form.value, rounding += form_rounding * epsilon * form.size;
  }
  energy.evaluate(here);
  const double third = stiffness[1] - stiffness[0], work = v.dot(energy.load_derivative());
  return std::abs(third) <= rounding || sign_ * third * work >= 0;
}

bool Branch::find_user_events(Segment segment, Candidate& c, std::string& why) {
  segment.b = c.parameter;
  bool missed = false;
  Equilibrium end = c.e;
  if (!c.events.empty() && c.events.front().arrival) {         // this branch, not the one that is met
    const Event& arrival = c.events.front();
    end.tangent = arrival.passing / (std::abs(arrival.passing_load) > 1e-100 ? arrival.passing_load : 1e-100);
  }
  std::vector<Event> seen = locate_user_events(user_events_, side_, segment, current_, end, negative_, missed);
  if (missed) return why = "where an observable reaches its value could not be located", false;
  if (seen.empty()) return true;
  if (std::abs(c.parameter - seen.front().at_parameter) > branch::coincide * std::abs(segment.b - segment.a))
    c.parameter = seen.front().at_parameter, c.e = seen.front().at, c.events.clear();
  std::move(seen.begin(), seen.end(), std::back_inserter(c.events));
  return true;
}

void Branch::take(const Candidate& c) {
  const Event* event = deciding(c);
  singular_ = is_critical(event);
  at_contact_ = event && event->kind == EventKind::contact;
  negative_ = event ? event->after : c.e.point.stability.negative;
  const bool told = event && (event->beyond || event->kind == EventKind::contact);
  ContactSet closed = told ? event->closed : closed_contacts(newton_.energy(), c.e);
  changed_ = told ? difference(closed, closed_) : ContactSet{};
  if (current_.slack && c.e.slack) closed.merge(closed_);        // what has touched is not told again before something bears a force
  closed_ = std::move(closed);
  pass_user_events(user_events_, c.events, c.e.point.state, side_);
  soft_before_ = c.events.empty() ? current_.soft_values : Vector(), load_before_ = current_.point.state.load_factor;
  const int family = current_.family;
  current_ = event && event->beyond ? *event->beyond : c.e;
  current_.family = family;                                     // once one, always one
  current_.point.label.clear();
  if (c.events.empty()) return;
  current_.point.stability.negative = negative_;
  if (singular_ && current_.soft.cols() > 0) current_.soft = event->modes;
  current_.lowest = {}, newton_.factors().expect(negative_ > 0, current_.soft);         // as where a path is taken up
  if (event) current_.point.stability.critical = 0;             // what is singular here has been told
}

}  // namespace elamin
