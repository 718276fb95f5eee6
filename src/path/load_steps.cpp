#include "path/load_steps.hpp"

#include "core/interrupt.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace elamin {

using namespace limits;

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

double snap_begins(const PathOptions& o, double at, double part) {
  const double range = o.to - o.from;
  if ((o.to - at) / range < continuation::least_snap) return o.to;
  std::vector<double> met = o.stops;
  for (const double end : {o.to, o.lowest.value_or(o.to), o.highest.value_or(o.to)}) met.push_back(end);
  for (const double stop : met)
    if (const double ahead = (stop - at) / range; ahead > continuation::least_snap) part = std::min(part, ahead / 2);
  return at + part * range;
}

LoadSteps::LoadSteps(Newton& newton, Departure from, const PathOptions& options)
    : Branch(newton, std::move(from), options.contacts, options.event_errors, options.user_events), grid_(load_targets(options), options.start.value_or(options.from)),
      correct_(options.correct) {
  sign_ = options.to < options.from ? -1 : 1;
  grid_.restart(current_.point.state.load_factor);
  patience_.since = current_.point.state.load_factor, patience_.creep = load_steps::creep * std::abs(options.to - options.from) / options.steps;
  searches_ = options.limits || options.branch_points || options.contacts || options.branches > 0 || options.when_unstable != WhenUnstable::jump;
  if (options.when_unstable == WhenUnstable::jump && may_touch(newton.energy().model())) patience_.most = load_steps::patience;
}

void LoadSteps::carry(Archive& archive) {
  Branch::carry(archive);
  bool detour = detour_.has_value();
  archive(grid_, critical_, goal_, taken_, met_, patience_, detour);
  if (archive.reads()) detour_.reset();
  if (archive.reads() && detour) detour_.emplace(newton_, Departure{.closed = {}, .sides = side_}, Direction{}, Metric{}, ArcOptions{.user_events = user_events_, .step = 1});
  if (detour) archive(*detour_);
}

bool LoadSteps::search() {
  if (searches_) return false;
  searches_ = true;
  stop_here(Status::converged, {});
  return true;
}

std::optional<Waypoint> LoadSteps::next() {
  const double here = current_.point.state.load_factor;
  std::string why;
  if (current_.family == 1) std::ignore = rest_in_family(newton_, current_);
  bool explored = false;
  while (!grid_.done() && patient() && !interrupted() && status() == Status::converged) {
    if (detour_) {
      if (std::optional<Waypoint> w = on_detour()) return w;
      explored = true;
    } else {
      // Where something may touch, a step beyond a limit point is refused after many iterations only: it is not tried.
      const double limit = way_to_limit();
      if (!explored && searches() && limit < std::abs(grid_.next() - here) && may_touch(newton_.energy().model())) {
        set_out_on_detour(limit);
        continue;
      }
      if (std::optional<Candidate> c = reach(grid_.next(), why)) return accept(std::move(*c));
      if (std::optional<Candidate> c = meet(grid_.next())) return accept(std::move(*c));
      const bool caught = (current_.pushed || current_.point.state.load_factor == met_) && way_is_free(grid_.next());
      patience_.refused += caught ? load_steps::caught : contacts_ ? 0 : 1;
      if (!searches() && grid_.halvings() >= load_steps::coarse) {
        stop_here(Status::not_converged, fmt::format("load factor {:.10g} could not be passed: {}", here, why));
        return {};
      }
      const int since_detour = grid_.halvings() - load_steps::first_detour;
      if (!(caught && patience_.most > 0) && since_detour >= 0 && since_detour % load_steps::next_detour == 0) {
        set_out_on_detour();
        continue;
      }
    }
    if (grid_.halve()) continue;
    stop_here(Status::not_converged, fmt::format("load factor {:.10g} could not be passed even in steps of {:.3g}: {}", here, std::abs(grid_.next() - here), why));
  }
  if (!patient()) stop_here(Status::not_converged, fmt::format("load factor {:.10g} could not be passed in {} steps{}", here, patience_.refused, why.empty() ? "" : ": " + why));
  else if (grid_.done()) stop_here(Status::converged, fmt::format("load factor {:.10g} reached", here));
  else if (interrupted()) stop_here(Status::interrupted, fmt::format("interrupted at load factor {:.10g}", here));
  return {};
}

// Right behind a branch point its critical modes are free, or held where that leads to another branch.
std::optional<Branch::Candidate> LoadSteps::reach(double target, std::string& why) {
  const double here = current_.point.state.load_factor;
  if (at_contact_ && here != met_) current_ = past_contact(load_steps::past_contact * std::abs(target - here));
  at_contact_ = false;
  Corrector correct = correct_;
  if (!correct && !searches() && !current_.floats)         // the snap is the minimisation
    correct = [this](State& state) { return newton_.correct(state, current_.zero_modes, &current_.point.state, equilibrium::most_iterations); };
  std::optional<Candidate> c = corrected(current_, target, why, correct);
  if (c && ends_on_event(*c)) {
    std::optional<Candidate> longer = corrected(current_, here + load_steps::longer * (target - here), why, correct);
    if (longer) longer = with_events(std::move(*longer), why);
    if (!longer && (c->e.point.stability.critical > 0 || c->e.point.stability.zero == 0)) return why = "it ends on an event by chance", std::nullopt;
    if (longer && !longer->events.empty() && (longer->parameter - target) * sign_ <= load_steps::on_target * std::abs(target - here)) return longer;
  }
  const bool pushed = c && ((current_.slack && c->e.slack) || current_.pushed || c->e.pushed);
  if (c && grid_.halvings() < load_steps::fine && may_touch(newton_.energy().model()) && !singular_ && !pushed &&
      bends(newton_.energy().kinematics(), current_, c->e, load_steps::most_bend))
    return why = "the branch bends too much to be told from another one", std::nullopt;
  const bool doubted = c && searches() && grid_.halvings() < load_steps::fine && !pushed && current_.family == 0;
  if (doubted && may_hide_limits(*c)) return why = "the structure softens so much that limit points may lie within the step", std::nullopt;
  if (c) c = with_events(std::move(*c), why);
  if (c && doubted && c->events.empty() && c->e.point.report.iterations > load_steps::most_iterations)
    return why = "the corrector went so far that it may have gone to another branch", std::nullopt;
  if (c || !singular_ || critical_.cols() == 0) return c;
  Equilibrium held = current_;
  held.zero_modes = side_by_side(held.zero_modes, critical_);
  return reach_load(held, target, why);
}

// Whether an eigenvalue vanishes just where a step ends; at a limit point as nearly as the root of the load factor's rounding tells.
bool LoadSteps::ends_on_event(const Candidate& c) const {
  if (!searches() || c.e.slack || c.e.pushed || singular_) return false;
  const Vector &before = current_.soft_values, &after = c.e.soft_values;
  const bool vanishes = after.size() > 0 && after.minCoeff() < load_steps::vanished * (before.size() > 0 ? before.minCoeff() : after.maxCoeff());
  return vanishes || c.e.zero_modes.cols() > current_.zero_modes.cols();
}

// Whether two limit points may lie within a step from a stable equilibrium to another one, between which the load factor goes back. Before a limit point at λ_c the
// softest eigenvalue falls as  μ² ∝ λ_c − λ,  so that  λ_c − λ = μ / (2 |dμ/dλ|):  this distance is compared with the step.
bool LoadSteps::may_hide_limits(const Candidate& c) {
  if (singular_ || current_.slack || negative_ != 0 || c.e.point.stability.negative != 0) return false;
  const double way = c.parameter - current_.point.state.load_factor;
  see_softest_here(c, branch::little * way);
  for (Eigen::Index i = 0; i < current_.softest.values.size(); ++i)
    if (current_.softest.values[i] > 0 && current_.softest.values[i] < -2 * way * current_.softening[i]) return true;
  return false;
}

// Whether nothing that is prescribed goes through anything until then.
bool LoadSteps::way_is_free(double target) const {
  State driven = current_.point.state;
  newton_.energy().kinematics().prescribe(driven, target);
  return newton_.energy().collision_free_step(current_.point.state, driven) == 1;
}

// Where what floats meets something on the way: from there it is pushed, or caught.
std::optional<Branch::Candidate> LoadSteps::meet(double target) {
  const double here = current_.point.state.load_factor, way = target - here;
  if (!current_.floats || current_.pushed || negative_ != 0 || singular_ || here == met_) return {};
  std::optional<ContactChange> change = kink_ahead(newton_, closed_, current_, way * current_.tangent, way);
  if (!change) return {};
  const double there = change->at.point.state.load_factor;
  if (!((there - here) * sign_ > 0 && (target - there) * sign_ > 0)) return {};
  Candidate c = with_contact(Candidate{.parameter = there, .e = {}, .natural = true}, std::move(*change));
  c.events.front().after = negative_;
  std::string why;
  if (!find_user_events(segment_of_loads(newton_, here, there), c, why)) return {};
  met_ = there;
  return c;
}

Waypoint LoadSteps::accept(Candidate c) {
  if (c.events.empty()) grid_.arrive();
  else grid_.restart(c.e.point.state.load_factor);
  arrived(c);
  return {std::move(c.e), std::move(c.events)};
}

void LoadSteps::arrived(const Candidate& c) {
  const double load = c.e.point.state.load_factor;
  if (!c.events.empty() || std::abs(load - patience_.since) >= patience_.creep) patience_.since = load, patience_.refused = 0;
  critical_ = c.events.empty() ? Eigen::MatrixXd() : c.events.front().modes;
  take(c);
}

// What stops the steps, told by arc length: an event that load steps cannot meet themselves, or an equilibrium beyond.
// `limit`: how far ahead a limit point may be, which the first step is not to go beyond.
void LoadSteps::set_out_on_detour(double limit) {
  const double here = current_.point.state.load_factor, way = grid_.next() - here;
  goal_ = grid_.next(), taken_ = 0;
  ArcOptions a{.load_step = std::abs(way), .rotation = 0.1, .contacts = contacts_, .event_errors = event_errors_, .stops = {goal_, here - 100 * way}, .user_events = user_events_,
               .patience = patience_.most > 0 && !contacts_ ? patience_.most - patience_.refused : 0};
  std::sort(a.stops.begin(), a.stops.end());
  const Metric metric = metric_for(newton_.energy(), current_, way);
  const Direction towards{Vector::Zero(current_.tangent.size()), sign_ * metric.load};
  const Departure from{current_, negative_, closed_, singular_, at_contact_, side_, changed_};
  Direction direction = direction_of(current_, metric, towards);
  if (std::isfinite(limit)) a.step = limit / std::abs(direction.load);
  detour_.emplace(newton_, from, std::move(direction), metric, std::move(a));
}

// It ends at its goal, at the first event, or where it leads nowhere: nothing is told then, and the next step is shorter.
std::optional<Waypoint> LoadSteps::on_detour() {
  const int before = detour_->refused();
  std::optional<Waypoint> w = ++taken_ <= load_steps::longest_detour ? detour_->next() : std::nullopt;
  if (!contacts_) patience_.refused += detour_->refused() - before;
  if (w && w->stop && *w->stop != goal_) w.reset();
  if (!w) return detour_.reset(), std::nullopt;
  const double load = w->at.point.state.load_factor;
  const bool told = std::any_of(w->events.begin(), w->events.end(), [&](const Event& event) { return contacts_ || event.kind != EventKind::contact; });
  const bool there = told || (load - goal_) * sign_ >= 0;
  grid_.restart(load, told ? 0 : std::max(0, grid_.halvings() - 1));
  arrived(Candidate{.parameter = load, .e = w->at, .events = w->events});
  if (there) detour_.reset();
  return Waypoint{std::move(w->at), std::move(w->events)};
}

}  // namespace elamin
