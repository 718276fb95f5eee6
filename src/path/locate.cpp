#include "path/locate.hpp"

#include "energy/step_limits.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/root.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

using namespace limits;

namespace {

// The lowest eigenpairs at the equilibrium without the known zero modes Z: of the span V of so many eigenvectors more as
// there are known ones, what is orthogonal to VᵀZ. So it does not matter how a critical mode and a zero mode mix where
// their eigenvalues meet, and the stiff directions, in which Z is not exact beside its own state, stay out.
// `e.lowest` is where the search begins and what it leaves for a neighbour.
EigenPairs lowest_but(Newton& newton, Equilibrium& e, const Eigen::MatrixXd& known, int count) {
  newton.energy().evaluate(e.point.state);
  const double guess = e.lowest.values.size() > 0 ? 2 * e.lowest.values.cwiseAbs().maxCoeff() : 0.0;
  const EigenPairs pairs = e.lowest = newton.factors().lowest(count + static_cast<int>(known.cols()), guess, 1e-11, e.lowest.vectors);
  if (known.cols() == 0 || pairs.values.size() <= known.cols()) return pairs;
  const Eigen::MatrixXd others = complement(pairs.vectors.transpose() * known);
  const EigenPairs small = symmetric_eigen(others.transpose() * pairs.values.asDiagonal() * others);
  return {small.values, pairs.vectors * (others * small.vectors)};
}

// The eigenvalue number `index` (from 0, ascending) that belongs to neither a rigid motion nor a symmetry.
double eigenvalue(Newton& newton, Equilibrium& e, int index) {
  const Vector values = lowest_but(newton, e, e.zero_modes, index + 1 + locate::more_modes).values;
  return values.size() == 0 ? 0.0 : values[std::min<Eigen::Index>(index, values.size() - 1)];
}

// The same near to its zero, from the eigenvectors of a neighbour: it is then among those nearest to zero, and which it is
// the Morse index tells.
double critical_value(Newton& newton, Equilibrium& e, int index) {
  newton.energy().evaluate(e.point.state);
  Eigen::MatrixXd start = e.lowest.vectors;
  if (e.zero_modes.cols() > 0) start -= e.zero_modes * (e.zero_modes.transpose() * start);
  e.lowest = newton.factors().nearest_zero(start, e.zero_modes);
  newton.factors().refine(e.lowest);
  const Vector& values = e.lowest.values;
  Eigen::Index least = 0;
  if (values.cwiseAbs().minCoeff(&least) <= 4 * newton.factors().zero_level()) return values[least];
  const Eigen::Index k = index - (e.point.stability.negative - (values.array() < 0).count());
  return k < values.size() ? values[std::max<Eigen::Index>(k, 0)] : eigenvalue(newton, e, index);      // of more that are negative one that changes its sign later
}

// Eigenvectors whose eigenvalues are zero beside `scale`, without the zero modes that were there before.
Eigen::MatrixXd critical_modes(Newton& newton, Equilibrium& e, int index, double scale, const Eigen::MatrixXd& known) {
  const EigenPairs pairs = lowest_but(newton, e, known, index + locate::most_multiple);
  Eigen::MatrixXd modes(pairs.vectors.rows(), 0);
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j)
    if (std::abs(pairs.values[j]) <= scale) {
      modes.conservativeResize(Eigen::NoChange, modes.cols() + 1);
      modes.rightCols(1) = pairs.vectors.col(j);
    }
  if (modes.cols() > 0) modes = newton.factors().nearest_zero(modes, known).vectors;
  return symmetric_modes(newton.energy(), e.point.state, modes);
}

// Zero modes of the branch: those that both ends have.
Eigen::MatrixXd persistent(const Equilibrium& a, const Equilibrium& b) {
  return a.zero_modes.cols() <= b.zero_modes.cols() ? a.zero_modes : b.zero_modes;
}

// How much of the load does work along a critical mode: none at a branch point.
double work_along(const Eigen::MatrixXd& modes, const Vector& load_derivative) {
  const double load = load_derivative.norm();
  return load > 0 && modes.rows() > 0 ? (modes.transpose() * load_derivative).norm() / load : 0.0;
}

// Of the eigenvectors that are known of an equilibrium those with eigenvalues up to ± `most`, orthogonal to the zero modes.
Eigen::MatrixXd soft_modes(const Equilibrium& e, double most, const Eigen::MatrixXd& known) {
  Eigen::MatrixXd modes(e.lowest.vectors.rows(), 0);
  for (Eigen::Index j = 0; j < e.lowest.values.size(); ++j) {
    if (std::abs(e.lowest.values[j]) > most) continue;
    Vector v = e.lowest.vectors.col(j);
    if (known.cols() > 0) v -= known * (known.transpose() * v);
    if (v.norm() < 0.5) continue;                              // one of those that are known
    modes.conservativeResize(Eigen::NoChange, modes.cols() + 1);
    modes.rightCols(1) = v.normalized();
  }
  return modes;
}

// How the branch moves along its critical modes, which is what the linear equations at a branch point do not tell.
void move_along_modes(Equilibrium& at, const Eigen::MatrixXd& modes, const Interpolated& between) {
  if (between.load_rate != 0 && modes.cols() > 0) at.tangent += modes * (modes.transpose() * between.rate) / between.load_rate;
}

void hold_modes(Newton& newton, Equilibrium& e, const Eigen::MatrixXd& known, const Eigen::MatrixXd& modes) {
  newton.energy().evaluate(e.point.state);
  newton.factors().factorize_holding(side_by_side(known, modes));
  e.tangent = newton.factors().solve_holding(-newton.energy().load_derivative());
}

// On the chord between two samples.
State chord(const Kinematics& kinematics, const Sample& a, const Sample& b, double t) {
  const double part = (t - a.t) / (b.t - a.t), from = a.e.point.state.load_factor;
  State state = a.e.point.state;
  kinematics.prescribe(state, from + part * (b.e.point.state.load_factor - from));
  kinematics.retract(state, kinematics.difference(a.e.point.state, b.e.point.state), part);
  return state;
}

// Whether the states on both sides of a zero are as near to each other as their parameters: a branch is continuous. Else the eigenvalue has
// changed its sign in a leap between two branches that pass by each other, as those of an unfolded pitchfork do.
bool meet(const Kinematics& kinematics, const Segment& segment, const Equilibrium& a, const Equilibrium& b, const Sample& below, const Sample& above) {
  const auto apart = [&](const Equilibrium& from, const Equilibrium& to) { return kinematics.difference(from.point.state, to.point.state).norm(); };
  const double part = std::abs((above.t - below.t) / (segment.b - segment.a));
  return apart(below.e, above.e) <= (equilibrium::same_end + locate::steepest * part) * apart(a, b);
}

// Whether the branch from an equilibrium, at which the eigenvalue is `value`, comes to a limit point here rather than to a branch point,
// however little of the load does work w along the critical mode, as where a structure is stiff along the load:  g = w (λ − λ*) + w c a²
// over the amplitude a has its zeros at  w (λ − λ*) = −μ a/2; at a branch point w = 0.
bool comes_to_limit(const Kinematics& kinematics, const Equilibrium& from, double value, const Equilibrium& at,
                    const Eigen::MatrixXd& modes, const Vector& load) {
  if (modes.cols() != 1) return false;
  const double w = std::abs(modes.col(0).dot(load)), change = at.point.state.load_factor - from.point.state.load_factor;
  const double way = kinematics.difference(from.point.state, at.point.state).norm();
  return w > locate::work_rounding * load.norm() && w * std::abs(change) > locate::of_limit * std::abs(value) * way;
}

// Whether a force φᵀg is left along a critical mode that is more than rounding, summed element by element: it unfolds a pitchfork, whose branches pass by each other.
bool is_unfolded(Energy& energy, const State& state, const Eigen::MatrixXd& modes) {
  if (!state.hard.empty()) return false;
  energy.evaluate(state, false);
  for (Eigen::Index j = 0; j < modes.cols(); ++j) {
    const BilinearForm force = energy.slope(modes.col(j));
    if (std::abs(force.value) > locate::unfolding * slope_rounding * epsilon * (force.size + epsilon * energy.force_scale())) return true;
  }
  return false;
}

// turns: of the load factor on the segment; nothing: it does not tell. lower, upper: its ends, of which one may be on a branch that passes by, as beside a
// pitchfork that a small force has unfolded.
Event finish(Newton& newton, const Sample& lower, const Sample& upper, Equilibrium at, int index, double scale, const Eigen::MatrixXd& known,
             std::optional<bool> turns) {
  Event event;
  event.modes = critical_modes(newton, at, index, scale, known);
  newton.energy().evaluate(at.point.state);
  const Vector load = newton.energy().load_derivative();
  const auto limit_from = [&](const Sample& end) { return comes_to_limit(newton.energy().kinematics(), end.e, end.f, at, event.modes, load); };
  const bool works = work_along(event.modes, load) > locate::orthogonal || limit_from(lower) || limit_from(upper);
  const bool limit = turns.value_or(works);
  if (!limit && works) event.modes.resize(event.modes.rows(), 0);       // nor a branch point: two branches pass by each other
  event.kind = limit && event.modes.cols() == 1 ? EventKind::limit : EventKind::branch;
  hold_modes(newton, at, known, event.kind == EventKind::branch ? event.modes : Eigen::MatrixXd());
  at.point.multiplicity = static_cast<int>(event.modes.cols());
  at.point.stability.stable = false;
  at.zero_modes = known;
  event.at = std::move(at);
  return event;
}

}  // namespace

namespace {

// A branch point with one mode φ, by its equations; none where they do not make it more exact. The force along φ vanishes there to second order in the load
// factor λ and the amplitude α of φ: a search along the branch, which holds α at its interpolated value, finds the point to the square root of a residual.
// The derivatives of that force vanish to first order,
//   μ = 0,   w = φᵀ∂g/∂λ = 0     (Moore 1980, SIAM J. Numer. Anal. 17).
// Newton's method solves this for (λ, α), by differences of equilibria with α held, as long as w becomes smaller. `range`: of the load factor, `scale`: of μ.
std::optional<Equilibrium> settle_branch_point(Newton& newton, const Event& event, const Eigen::MatrixXd& known, double range, double scale) {
  Energy& energy = newton.energy();
  struct Place { Equilibrium e; Eigen::MatrixXd mode; double value, work; };
  const auto beside = [&](const Place& from, double load_change, double amplitude) -> std::optional<Place> {
    Place there = from;
    State& state = there.e.point.state;
    if (load_change != 0 || amplitude != 0) {
      energy.kinematics().prescribe(state, state.load_factor + load_change);
      energy.kinematics().retract(state, from.mode.col(0) * amplitude);
      const Report report = newton.correct(state, side_by_side(known, from.mode), nullptr, locate::most_iterations);
      if (!report.converged()) return {};
      there.e = assess(newton, state, report);
    }
    energy.evaluate(there.e.point.state);
    EigenPairs nearest = newton.factors().nearest_zero(from.mode, known);
    newton.factors().refine(nearest);
    there.value = nearest.values[0];
    there.mode = nearest.vectors * (nearest.vectors.col(0).dot(from.mode.col(0)) < 0 ? -1 : 1);
    there.work = there.mode.col(0).dot(energy.load_derivative());
    return there;
  };
  const double load_step = event_error::step * range, step = event_error::step / step_size(energy, event.at.point.state, event.modes.col(0));
  std::optional<Place> here = beside({event.at, event.modes, 0, 0}, 0, 0);
  bool moved = false;
  for (int k = 0; k < locate::most_settling && here; ++k) {
    const std::optional<Place> loaded = beside(*here, load_step, 0), bent = beside(*here, 0, step);
    if (!loaded || !bent) break;
    Eigen::Matrix2d slopes;
    slopes << (loaded->value - here->value) / load_step, (bent->value - here->value) / step, (loaded->work - here->work) / load_step, (bent->work - here->work) / step;
    const Eigen::Vector2d change = -slopes.inverse() * Eigen::Vector2d(here->value, here->work);
    const bool near = change.allFinite() && change.cwiseQuotient(Eigen::Vector2d(load_step, step)).cwiseAbs().maxCoeff() <= locate::farthest_settling;
    if (!near || std::abs(change[0]) <= locate::load_rounding * std::abs(here->e.point.state.load_factor)) break;
    std::optional<Place> next = beside(*here, change[0], change[1]);
    if (!next || !(std::abs(next->work) <= std::abs(here->work) / 2)) break;
    here = std::move(next), moved = true;
  }
  if (!moved || !here || std::abs(here->value) > locate::next_to_nothing * scale) return {};
  return here->e;
}

}  // namespace

std::optional<Event> locate_crossing(Newton& newton, const Segment& segment, const Equilibrium& a, int before, const Equilibrium& b,
                                     std::optional<bool> turns) {
  const int after = b.point.stability.negative;
  const int index = after > before ? before : before - 1;      // the sorted eigenvalue that changes sign first
  const std::optional<bool> told = std::abs(after - before) == 1 ? turns : std::nullopt;
  const Eigen::MatrixXd known = persistent(a, b);
  Equilibrium first = a, second = b;
  first.zero_modes = second.zero_modes = known;
  const auto done = [&](Event event, double parameter) -> std::optional<Event> {
    event.at_parameter = parameter, event.before = before;
    event.after = before + (after > before ? 1 : -1) * std::max(1, static_cast<int>(event.modes.cols()));
    if (event.modes.cols() == 0) return {};
    return event;
  };
  Sample lower{segment.a, eigenvalue(newton, first, index), first};
  if (std::abs(lower.f) <= newton.factors().zero_level() && a.point.stability.critical > 0)       // a is the event itself
    return done(finish(newton, lower, lower, first, index, newton.factors().zero_level(), known, told), segment.a);
  Sample upper{segment.b, eigenvalue(newton, second, index), second};
  if (std::abs(lower.f) <= 1e-8 * std::abs(upper.f) || (lower.f < 0) == (upper.f < 0)) return {};
  const double scale = std::max(std::abs(lower.f), std::abs(upper.f));
  const auto resolution = [&](double t) { return segment.resolution(t); };
  const double nothing = vanished_below(scale, newton.factors().zero_level());
  // A force that is left along the critical modes breaks the branch point: then there is none.
  const double rounding = 1e-13 + 100 * std::max(a.point.report.residual, b.point.report.residual);
  State just_before;                                           // an equilibrium on this side of the zero
  const auto between = [&](double t) { return interpolate(newton.energy().kinematics(), segment, a, b, segment.a, segment.b, t); };
  // free: nothing is held, as at a limit point. At a branch point the equations are regular with the critical modes held where the branch has them.
  const auto search = [&](bool free) -> std::optional<Sample> {
    const auto good = [&](const Equilibrium& e) { return e.point.report.converged() && (free || e.point.report.residual <= rounding); };
    Sample below = lower, above = upper;                        // the last ones on both sides of the zero
    just_before = lower.e.point.state;
    const auto sample = [&](double t, const Sample& from, Equilibrium e) {
      e.zero_modes = known, e.lowest = from.e.lowest;
      const double value = critical_value(newton, e, index);
      const Sample s{t, value, std::move(e)};
      const bool ahead = (value < 0) == (lower.f < 0);
      (ahead ? below : above) = s;
      if (ahead && std::abs(value) > locate::little_before * std::abs(lower.f)) just_before = s.e.point.state;
      return s;
    };
    const auto held_at = [&](const Sample& from) {
      return free ? Eigen::MatrixXd() : soft_modes(from.e, locate::vanishing_together * std::abs(from.f), known);
    };
    const auto settled = [&](State& state, const Eigen::MatrixXd& modes, const auto& settle) {
      Equilibrium e;
      const Report report = settle(state, side_by_side(known, modes));
      if (report.converged() && report.residual <= rounding) e = assess(newton, state, report);
      return e;
    };
    std::optional<Sample> zero = find_zero(lower, upper, resolution, [&](double t, const Sample& from) -> std::optional<Sample> {
      Equilibrium e;
      const Eigen::MatrixXd modes = held_at(from);
      if (modes.cols() > 0) {
        State state = between(t).state;
        e = settled(state, modes, segment.settle);
        // Where a contact is hardly closed a cubic from the ends is not near enough: the two next samples are.
        if (!good(e) && below.t != lower.t && above.t != upper.t) {
          state = chord(newton.energy().kinematics(), below, above, t);
          e = settled(state, modes, segment.settle);
        }
      }
      if (!good(e)) e = segment.at(t, from.e);
      if (!good(e)) return {};
      return sample(t, from, std::move(e));
    }, nothing);
    const bool small = zero && (std::abs(zero->f) <= nothing ||
                                (segment.rounding && std::abs(above.t - below.t) <= 4 * segment.rounding(zero->t)));
    if (!small || !meet(newton.energy().kinematics(), segment, a, b, below, above)) return {};
    // Where little moves as the load factor grows, rounding of what is soft in x is more in t than in λ, which the last step goes by.
    const double from = zero->e.point.state.load_factor, width = above.e.point.state.load_factor - below.e.point.state.load_factor;
    const double load = below.e.point.state.load_factor - below.f * width / (above.f - below.f);
    const Eigen::MatrixXd modes = held_at(*zero);
    if (modes.cols() > 0 && std::abs(load - from) > locate::load_rounding * std::abs(load)) {
      State state = zero->e.point.state;
      newton.energy().kinematics().prescribe(state, load);
      const Equilibrium e = settled(state, modes, [&](State& x, const Eigen::MatrixXd& held) { return newton.correct(x, held, nullptr, locate::most_iterations); });
      if (good(e))
        if (const Sample s = sample(zero->t, *zero, e); std::abs(s.f) < std::abs(zero->f)) zero = s;
    }
    return zero;
  };
  const auto finished = [&](const Sample& zero, std::optional<bool> limit) {
    return finish(newton, lower, upper, zero.e, index, std::max(1e-7 * scale, 4 * std::abs(zero.f)), known, limit);
  };
  std::optional<Sample> zero = search(told.value_or(false));
  if (!zero) return {};
  Event event = finished(*zero, told);
  // Of a limit point what was held has kept a force that a branch point does not have: it is told where nothing is held, or is none.
  if (event.kind == EventKind::limit && !told) {
    zero = search(true);
    if (!zero) return {};
    event = finished(*zero, true);
  }
  if (event.kind == EventKind::branch && event.modes.cols() == 1 && work_along(event.modes, newton.energy().load_derivative()) > locate::settled) {
    const double range = std::abs(second.point.state.load_factor - first.point.state.load_factor);
    if (std::optional<Equilibrium> e = settle_branch_point(newton, event, known, range, scale)) {
      e->zero_modes = known, e->lowest = zero->e.lowest;
      const double value = critical_value(newton, *e, index);
      zero = Sample{zero->t, value, std::move(*e)};
    }
    event = finished(*zero, told);                              // anew: the factors are those of other places
  }
  if (event.kind == EventKind::branch && is_unfolded(newton.energy(), event.at.point.state, event.modes)) return {};
  if (event.kind == EventKind::branch) move_along_modes(event.at, event.modes, between(zero->t));
  else event.passing = event.modes * (event.modes.transpose() * newton.energy().kinematics().difference(just_before, zero->e.point.state));
  // As many eigenvalues are negative there as on the side that has fewer; more, and it is on another branch.
  if (event.at.point.stability.negative - event.modes.cols() > std::min(before, after)) return {};
  return done(std::move(event), zero->t);
}

namespace {

// Of Hermite's cubic at the part u of an interval: the weights of the whole change and of the rates at both ends.
struct Weights { double change, rate_a, rate_b; };
Weights hermite(double u, double width) { return {u * u * (3 - 2 * u), u * (1 - u) * (1 - u) * width, u * u * (u - 1) * width}; }

}  // namespace

std::function<double(double)> load_along(const Segment& segment, const Equilibrium& a, const Equilibrium& b) {
  const double from = a.point.state.load_factor, change = b.point.state.load_factor - from, width = segment.b - segment.a;
  return [=, ta = segment.a, la = segment.load_rate(a), lb = segment.load_rate(b)](double t) {
    const Weights w = hermite((t - ta) / width, width);
    return from + w.change * change + w.rate_a * la + w.rate_b * lb;
  };
}

Interpolated interpolate(const Kinematics& kinematics, const Segment& segment, const Equilibrium& a, const Equilibrium& b, double ta, double tb,
                         double t) {
  const double width = tb - ta, u = (t - ta) / width, la = segment.load_rate(a), lb = segment.load_rate(b);
  const auto [h01, h10, h11] = hermite(u, width);
  const double d01 = 6 * u * (1 - u) / width, d10 = (1 - u) * (1 - 3 * u), d11 = u * (3 * u - 2);
  const Vector moved = kinematics.difference(a.point.state, b.point.state);
  const double from = a.point.state.load_factor, change = b.point.state.load_factor - from;
  Interpolated point{a.point.state, d01 * moved + d10 * la * a.tangent + d11 * lb * b.tangent, d01 * change + d10 * la + d11 * lb};
  kinematics.prescribe(point.state, from + h01 * change + h10 * la + h11 * lb);
  kinematics.retract(point.state, h01 * moved + h10 * la * a.tangent + h11 * lb * b.tangent);
  return point;
}

Segment segment_of_loads(Newton& newton, double from, double to) {
  return {from, to, [&newton](double t, const Equilibrium& nearest) { return continue_to(newton, nearest, t); },
          [&newton](State& state, const Eigen::MatrixXd& held) { return newton.correct(state, held, nullptr, locate::most_iterations); },
          [](const State& state) { return state.load_factor; }, [](const Equilibrium&) { return 1.0; },
          [&newton](const Equilibrium& a, const Equilibrium& b) { return leads_to(newton, a, b); }};
}

std::optional<Event> locate_root(const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                 const std::function<double(const Equilibrium&)>& f) {
  const Sample lower{segment.a, f(a), a}, upper{segment.b, f(b), b};
  if ((lower.f < 0) == (upper.f < 0)) return {};
  const auto zero = find_zero(lower, upper, [&](double t) { return segment.resolution(t, root_search::rounding); }, [&](double t, const Sample& from) -> std::optional<Sample> {
    const Equilibrium e = segment.at(t, from.e);
    if (!e.point.report.converged()) return {};
    return Sample{t, f(e), e};
  });
  if (!zero) return {};
  return event_at(zero->e, zero->t);
}

std::vector<Event> locate_user_events(const std::vector<UserEvent>& user_events, const std::vector<double>& sides, const Segment& segment,
                                  const Equilibrium& a, const Equilibrium& b, int negative, bool& missed) {
  std::vector<Event> first;
  const double width = segment.b - segment.a;
  for (std::size_t k = 0; k < user_events.size(); ++k) {
    const UserEvent& w = user_events[k];
    const auto f = [&](const Equilibrium& e) { return w.observable(e.point.state) - w.value; };
    const double there = w.side(b.point.state);
    if (sides[k] == 0 || std::isnan(sides[k]) || std::isnan(there)) continue;      // not known; or nothing, as a derivative at a kink
    if (there != 0 && (sides[k] < 0) == (there < 0)) continue;
    if ((f(a) < 0) != (sides[k] < 0)) continue;                // it changes within rounding of `a`, where it has been told
    std::optional<Event> event = there == 0 ? event_at(b, segment.b) : locate_root(segment, a, b, f);
    if (!event) {
      missed = true;
      continue;
    }
    event->kind = EventKind::user, event->user_event = static_cast<int>(k), event->what = w.name;
    event->before = event->after = negative;
    const double behind = first.empty() ? 0.0 : (event->at_parameter - first.front().at_parameter) / width;
    if (behind > limits::branch::coincide) continue;
    if (behind < -limits::branch::coincide) first.clear();
    first.push_back(std::move(*event));
  }
  return first;
}

void pass_user_events(const std::vector<UserEvent>& user_events, const std::vector<Event>& passed, const State& state, std::vector<double>& sides) {
  for (std::size_t k = 0; k < user_events.size(); ++k) {
    const auto is = [&](const Event& e) { return e.kind == EventKind::user && e.user_event == static_cast<int>(k); };
    const double here = user_events[k].side(state);
    if (std::any_of(passed.begin(), passed.end(), is)) sides[k] = -sides[k];
    else if (here != 0) sides[k] = here;                       // at the value without passing it: it stays on its side
  }
}

namespace {

// The equilibrium at a load factor beside a branch point, on the branch of which all but the amplitude along the critical mode is known. What that is off by may be
// more than all that moves on the branch from here, so that no tangent tells the way; and of what is slender and all but critical the residual hardly tells how far
// off a state is, but Newton's steps do, as long as they shrink.
Equilibrium at_rest_beside(Newton& newton, const Equilibrium& at, double load_factor) {
  Energy& energy = newton.energy();
  State state = at.point.state;
  energy.kinematics().prescribe(state, load_factor);
  energy.kinematics().retract(state, at.tangent, load_factor - at.point.state.load_factor);
  const Report report = newton.correct(state, at.zero_modes, &at.point.state, equilibrium::most_iterations);
  if (!report.converged()) return {};
  for (double last = std::numeric_limits<double>::infinity();;) {
    energy.evaluate(state);
    if (!newton.factors().factorize_holding(at.zero_modes)) return {};
    const Vector step = -newton.factors().solve_holding(energy.gradient());
    if (step.norm() == 0 || !(step.norm() <= last / 2)) break;
    energy.kinematics().retract(state, step);
    last = step.norm();
  }
  return energy.collision_free_step(at.point.state, state) == 1 ? assess(newton, state, report) : Equilibrium{};
}

}  // namespace

std::optional<Event> locate_arrival(Newton& newton, const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                    const std::function<double(const Equilibrium&)>& slope) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Eigen::MatrixXd known = persistent(a, b);
  Sample lower{segment.a, slope(a), a}, upper{segment.b, slope(b), b};
  if ((lower.f < 0) == (upper.f < 0)) return {};
  const auto zero_of = [](const Sample& x, const Sample& y) { return x.t - x.f * (y.t - x.t) / (y.f - x.f); };
  for (int k = 0; k < locate::most_narrowings && upper.t - lower.t > locate::narrow * (segment.b - segment.a); ++k) {
    // Samples on both sides, near, but not where the equations are singular.
    const double zero = zero_of(lower, upper), margin = 0.1 * (upper.t - lower.t);
    const double t = zero - lower.t > upper.t - zero ? std::min(zero - margin, (lower.t + 3 * zero) / 4) : std::max(zero + margin, (upper.t + 3 * zero) / 4);
    if (!(t > lower.t && t < upper.t)) break;
    const Equilibrium e = segment.at(t, zero - t > 0 ? lower.e : upper.e);
    if (!e.point.report.converged()) break;
    const Sample next{t, slope(e), e};
    ((next.f < 0) == (lower.f < 0) ? lower : upper) = next;
  }
  const Interpolated touches = interpolate(kinematics, segment, lower.e, upper.e, lower.t, upper.t, zero_of(lower, upper));
  State state = touches.state;
  const double load = state.load_factor;
  // The branch that is met: there, and a little to both sides.
  energy.evaluate(state);
  Equilibrium at = lower.e;
  at.point.state = state;
  // All that vanishes there is held: what a double branch point has besides is singular, too.
  const int count = a.point.stability.negative + 1 + locate::more_modes;
  const auto least = [&](Equilibrium e) { return lowest_but(newton, e, known, count).values.cwiseAbs().minCoeff(); };
  const double ends = std::max(least(a), least(b));
  const EigenPairs pairs = lowest_but(newton, at, known, count);
  const double most = std::max(pairs.values.cwiseAbs().minCoeff(), locate::vanished * ends);
  Eigen::MatrixXd held = known;
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j)
    if (std::abs(pairs.values[j]) <= most) held = side_by_side(held, pairs.vectors.col(j));
  const Report report = newton.correct(state, held);
  if (!report.converged()) return {};
  at = assess(newton, state, report);
  hold_modes(newton, at, held, Eigen::MatrixXd());
  at.zero_modes = known;                                       // beside the point the critical mode is free, and comes to rest
  double part = 0.1 * std::max(std::abs(a.point.state.load_factor - load), std::abs(b.point.state.load_factor - load));
  for (int k = 0; k < 8; ++k, part *= 2) {
    const Equilibrium before = at_rest_beside(newton, at, load - part);
    if (!before.point.report.converged()) return {};
    const Equilibrium after = continue_to(newton, before, load + part);
    if (!after.point.report.converged()) return {};
    if (before.point.stability.negative == after.point.stability.negative) continue;
    const Segment along = segment_of_loads(newton, load - part, load + part);
    std::optional<Event> event = locate_crossing(newton, along, before, before.point.stability.negative, after, {});
    if (!event || event->kind == EventKind::limit) return {};
    event->at_parameter = segment.parameter(event->at.point.state);
    if (event->at_parameter < segment.a || event->at_parameter > segment.b) return {};
    event->before = a.point.stability.negative, event->after = b.point.stability.negative;
    event->arrival = true;
    event->passing = touches.rate, event->passing_load = touches.load_rate;
    return event;
  }
  return {};
}

}  // namespace elamin
