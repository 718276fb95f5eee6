#include "path/arc_length.hpp"

#include "path/cause.hpp"
#include "path/jump.hpp"
#include "path/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr double least_length = 1e-6;         // of the extent
constexpr double beyond_event = 1e-3;         // of the range of load factors: where a jump is made
constexpr double same_point = 1e-6;           // of the structure's displacement scale: one branch point met twice

double range_of(const PathOptions& o) { return o.to - o.from; }

// The two particles of a bond that has shrunk to nothing, where its energy has a kink and a branch its end; else "".
std::string collapsed(const Model& model, const State& state) {
  constexpr double nothing = 1e-6;            // of the rest length
  for (const Bond& b : model.bonds) {
    const auto [i, j] = b.particles;
    if ((state.at(j) - state.at(i)).hi.norm() <= nothing * model.bond_types[b.type].rest_length)
      return fmt::format("particles {} and {}, which a bond joins, come together", model.id[i], model.id[j]);
  }
  return "";
}

}  // namespace

Metric metric_for(const Energy& energy, const Equilibrium& start, const PathOptions& options) {
  const double load = std::abs(range_of(options));
  const double least = least_length * span(energy.model()) * std::sqrt(std::max(1.0, static_cast<double>(energy.model().particles())));
  return {std::max(load * start.tangent.norm(), least), load};
}

WalkOptions walk_options(const PathOptions& o) {
  const double low = o.lowest.value_or(o.to > o.from ? o.from - 2 * range_of(o) : o.to);
  const double high = o.highest.value_or(o.to > o.from ? o.to : o.from - 2 * range_of(o));
  WalkOptions w;
  w.load_step = std::abs(range_of(o)) / o.steps;
  w.turn = std::clamp(5.0 / o.steps, 1e-3, 0.2);
  w.contacts = o.contacts;
  w.stops = o.stops;
  for (const double end : {low, high, o.to}) w.stops.push_back(end);
  std::sort(w.stops.begin(), w.stops.end());
  w.stops.erase(std::unique(w.stops.begin(), w.stops.end()), w.stops.end());
  w.watches = o.watches;
  return w;
}

ArcLength::ArcLength(Newton& newton, const State& start, PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), options_(std::move(options)), start_(start) {}

ArcLength::ArcLength(Newton& newton, SideBranch side, std::string parent, const std::vector<Event>& known, Metric metric,
                     PathOptions options, Numbering* numbering)
    : Path(numbering), newton_(newton), options_(std::move(options)), side_(std::move(side)), known_(known), metric_(metric) {
  parent_ = std::move(parent);
}

void ArcLength::begin() {
  if (side_) {
    branch_ = ++numbering().branches;
    Equilibrium at = side_->at;
    at.point.label.clear();
    set_out(at, side_->direction, -1, closed_contacts(newton_.energy(), at.point.state), side_->step);
    return;
  }
  std::string sentence;
  const double at = options_.start.value_or(options_.from);
  Equilibrium e = first_equilibrium(newton_, start_, at, options_.when_unstable, options_.resume.has_value(), sentence);
  if (!sentence.empty()) note(sentence);
  if (!e.point.report.converged()) return end(e.point.report.status, e.point.report.why);
  metric_ = metric_for(newton_.energy(), e, options_);
  note(fmt::format("arc length: |(x, λ)|² = |x|²/L² + λ²/Λ², |x| over all free coordinates, Λ = {:.4g}, L = {:.4g} and further on the least "
                   "Λ |dx/dλ| of the branch so far", metric_.load, metric_.length));
  e.point.label = "initial";
  emit(e.point);
  e.point.label.clear();
  if (e.point.stability.negative > 0 && options_.when_unstable == WhenUnstable::stop)
    return end(Status::converged, "the starting state is unstable");
  if (options_.resume && options_.resume->direction.size() == e.tangent.size()) return take_up(std::move(e), *options_.resume);
  Direction towards{Vector::Zero(e.tangent.size()), range_of(options_) > 0 ? metric_.load : -metric_.load};
  set_out(e, direction_of(e, metric_, towards), e.point.stability.negative, closed_contacts(newton_.energy(), e.point.state));
}

// As if the path had never stopped here.
void ArcLength::take_up(Equilibrium at, const Resume& resume) {
  metric_.length = resume.length;
  if (std::optional<Event> event = resumed_event(resume, at)) {
    if (event->before == 0 && event->after > 0 && options_.when_unstable != WhenUnstable::follow) {
      lose_stability(*event);
      return;
    }
    at = std::move(event->at);
  }
  if (resume.tangent.size() == at.tangent.size()) at.tangent = resume.tangent;
  at.point.label.clear();
  at.point.stability.critical = 0;
  set_out(at, {resume.direction, resume.load}, resume.after >= 0 ? resume.after : at.point.stability.negative, resumed_contacts(resume),
          resume.step, resume.shortest);
}

void ArcLength::set_out(const Equilibrium& from, const Direction& direction, int negative, ContactSet closed, double step, double shortest) {
  WalkOptions w = walk_options(options_);
  w.step = step, w.shortest = shortest;
  if (step > 0 && options_.resume && !walk_) w.told = options_.resume->label;
  walk_.emplace(newton_, from, direction, negative, std::move(closed), metric_, std::move(w));
  first_ = from, first_direction_ = direction, left_ = false, travelled_ = 0;
}

void ArcLength::advance() {
  if (!walk_) return begin();
  const int most = options_.most_points > 0 ? options_.most_points : 20 * options_.steps;
  if (++points_ > most)
    return end(Status::converged, fmt::format("stopped after {} points of one branch (path.points), at load factor {:.10g}", most,
                                              walk_->at().point.state.load_factor));
  std::optional<Waypoint> waypoint = walk_->next();
  if (!waypoint) {
    const std::string together = collapsed(newton_.energy().model(), walk_->at().point.state);
    if (walk_->status() != Status::not_converged) return end(walk_->status(), walk_->why());
    if (together.empty()) {
      const std::string cause = cause_at(newton_, walk_->at());
      return end(Status::not_converged, walk_->why() + (cause.empty() ? "" : "; " + cause));
    }
    return end(Status::converged, fmt::format("the branch ends at load factor {:.10g}, where {}", walk_->at().point.state.load_factor, together));
  }
  show(std::move(*waypoint));
}

void ArcLength::show(Waypoint waypoint) {
  const double load = waypoint.at.point.state.load_factor;
  waypoint.at.point.resume = resume_here(waypoint);
  const Vector from_first = newton_.energy().kinematics().difference(first_.point.state, waypoint.at.point.state);
  const double change = load - first_.point.state.load_factor;
  travelled_ = std::max(travelled_, std::sqrt(walk_->metric().dot(from_first, change, from_first, change)));
  for (Event& event : waypoint.events) {
    event.at.point.resume = waypoint.at.point.resume;
    const bool located = event.kind == EventKind::limit ? options_.limits : event.kind == EventKind::branch ? options_.branch_points : true;
    if (event.kind == EventKind::branch && meets_known(waypoint, event)) return;
    if (located) emit(event);
    else emit(waypoint.at.point);
  }
  for (const Event& event : waypoint.events)
    if (event.kind == EventKind::watch && options_.watches[event.watch].stop)
      return end(Status::converged, fmt::format("{} reached at load factor {:.10g}", event.what, load));
  for (Event& event : waypoint.events)
    if (event.kind != EventKind::watch && event.before == 0 && event.after > 0) return void(lose_stability(event));
  if (!waypoint.events.empty()) return;
  emit(waypoint.at.point);
  if (waypoint.stop) {
    const double stop = *waypoint.stop;
    if (stop == options_.to) return end(Status::converged, fmt::format("load factor {:.10g} reached", stop));
    if (std::find(options_.stops.begin(), options_.stops.end(), stop) == options_.stops.end())
      return end(Status::converged, fmt::format("the branch leaves the range of load factors at {:.10g}", stop));
  }
  if (closes_loop(waypoint)) end(Status::converged, fmt::format("the branch closes to a loop at load factor {:.10g}", load));
}

Resume ArcLength::resume_here(const Waypoint& waypoint) const {
  const bool any = !waypoint.events.empty();
  Resume r = any ? resume_of(waypoint.events.front(), walk_->closed()) : Resume{};
  r.tangent = waypoint.at.tangent;
  r.direction = walk_->direction().x, r.load = walk_->direction().load;
  r.length = walk_->metric().length, r.step = walk_->step(), r.shortest = walk_->shortest();
  if (!any) store(walk_->closed(), r);
  return r;
}

// The end, or a fall to another branch, if that is what the path does.
bool ArcLength::lose_stability(Event& event) {
  const double at = event.at.point.state.load_factor;
  if (options_.when_unstable == WhenUnstable::follow) return true;
  if (options_.when_unstable == WhenUnstable::stop) {
    end(Status::converged, fmt::format("stopped at {}, load factor {:.10g}", event.at.point.label, at));
    return false;
  }
  std::string what;
  Equilibrium landed = jump_from(newton_, event, at + beyond_event * range_of(options_), what);
  note(fmt::format("jump at {}: {}", event.at.point.label, what));
  if (!landed.point.report.converged()) {
    end(landed.point.report.status, landed.point.report.why);
    return false;
  }
  const Direction towards{Vector::Zero(landed.tangent.size()), range_of(options_) > 0 ? metric_.load : -metric_.load};
  set_out(landed, direction_of(landed, metric_, towards), landed.point.stability.negative,
          closed_contacts(newton_.energy(), landed.point.state));
  landed.point.resume = resume_here({landed, {}, {}});
  emit_landing(landed.point, what, event.before, event.at.point.label);
  return true;
}

// Whether this is a branch point that the diagram has already: then the branch ends there.
bool ArcLength::meets_known(const Waypoint& waypoint, const Event& event) {
  const Kinematics& kinematics = newton_.energy().kinematics();
  const State& state = waypoint.at.point.state;
  const Metric& metric = walk_->metric();
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const State& other = known_[k].at.point.state;
    const Vector apart = kinematics.difference(other, state);
    const double load = state.load_factor - other.load_factor;
    if (std::sqrt(metric.dot(apart, load, apart, load)) > same_point * travelled_) continue;
    emit(waypoint.at.point);
    arrived_at_ = static_cast<int>(k);
    arrival_ = event.arrival ? Vector(-walk_->direction().x.normalized()) : Vector(Vector::Zero(apart.size()));
    end(Status::converged, fmt::format("the branch arrives at {}, load factor {:.10g}", known_[k].at.point.label, state.load_factor));
    return true;
  }
  return false;
}

// Whether the last step passed the point where the branch began, in the same direction, after it had left it.
bool ArcLength::closes_loop(const Waypoint& waypoint) {
  const Metric& metric = walk_->metric();
  const Arc arc(newton_, waypoint.at, walk_->direction(), metric);
  const double s = arc.position(first_.point.state), away = arc.distance(first_.point.state), step = walk_->taken();
  if (!left_) {
    left_ = std::hypot(s, away) > 8 * step;
    return false;
  }
  return s <= 0 && s > -step && away < 0.25 * step &&
         cosine(walk_->direction(), first_direction_, metric) > 0.5 * std::sqrt(cosine(first_direction_, first_direction_, metric));
}

}  // namespace elamin
