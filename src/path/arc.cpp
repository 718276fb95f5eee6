#include "path/arc.hpp"

#include "model/entities.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

using namespace limits;

double span(const Model& model) {
  return std::max(sides_of(model.start).maxCoeff(), largest_size(model));
}

Direction direction_of(const Equilibrium& e, const Metric& metric, const Direction& along) {
  const double steep = e.tangent.norm() / metric.length;       // |dx/dλ| Λ/L may be beyond all bounds, not its inverse
  const double size = std::hypot(steep, 1 / metric.load);
  Direction d{e.tangent / size, 1 / size};
  if (metric.dot(d.x, d.load, along.x, along.load) < 0) d.x = -d.x, d.load = -d.load;
  return d;
}

double cosine(const Direction& a, const Direction& b, const Metric& metric) { return metric.dot(a.x, a.load, b.x, b.load); }

Chord chord(const Vector& x, double load, const Direction& begin, const Direction& end, const Metric& metric) {
  const Vector sum = begin.x + end.x;
  const double load_sum = begin.load + end.load;
  const double part = metric.dot(x, load, sum, load_sum) / metric.dot(sum, load_sum, sum, load_sum);
  const Direction off{x - part * sum, load - part * load_sum};
  return {part, off, std::sqrt(metric.dot(off.x, off.load, off.x, off.load) / metric.dot(x, load, x, load))};
}

double Arc::position(const State& state) const {
  const Vector x = newton_.energy().kinematics().difference(from_.point.state, state);
  return metric_.dot(x, state.load_factor - from_.point.state.load_factor, direction_.x, direction_.load);
}

double Arc::distance(const State& state) const {
  const double s = position(state);
  const Vector x = newton_.energy().kinematics().difference(from_.point.state, state) - s * direction_.x;
  const double load = state.load_factor - from_.point.state.load_factor - s * direction_.load;
  return std::sqrt(metric_.dot(x, load, x, load));
}

Plane Arc::plane() const {
  return {direction_.x / (metric_.length * metric_.length), direction_.load / (metric_.load * metric_.load), metric_.length, metric_.load};
}

// Where the arc begins, which may be a branch point, its own direction is the branch's.
Direction Arc::along(const Equilibrium& nearest) const {
  const bool begins = position(nearest.point.state) == 0 && distance(nearest.point.state) == 0;
  return begins ? direction_ : direction_of(nearest, metric_, direction_);
}

Report Arc::correct(State& state, double s, const Equilibrium& nearest) const {
  Energy& energy = newton_.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Direction d = along(nearest);
  const double step = (s - position(nearest.point.state)) / std::max(cosine(d, direction_, metric_), arc::least_cosine);
  state = nearest.point.state;
  kinematics.prescribe(state, state.load_factor + step * d.load);
  kinematics.retract(state, d.x, step);
  Report blocked;
  blocked.why = "the step would carry something through something else";
  if (energy.collision_free_step(nearest.point.state, state) < 1) return blocked;
  const Report report = correct_in_phase(energy, nearest, state, [&](State& x, const Eigen::MatrixXd& held) {
    return on_plane(x, held, &nearest.point.state);
  });
  return report.converged() && energy.collision_free_step(nearest.point.state, state) < 1 ? blocked : report;
}

Report Arc::settle(State& state, const Eigen::MatrixXd& held) const { return on_plane(state, held, nullptr); }

namespace {

// Whether forces change by less than a residual may be within the spacing of the load factors there; not where a wall that is moved
// presses too stiffly.
bool resolves_load(Newton& newton, const State& state) {
  Energy& energy = newton.energy();
  if (energy.model().walls.empty()) return true;
  State next = state;
  energy.kinematics().prescribe(next, state.load_factor * (1 + 4 * epsilon));
  energy.evaluate(next, false);
  const Vector there = energy.gradient();
  energy.evaluate(state, false);
  return energy.relative(there - energy.gradient()) <= newton.tolerance();
}

}  // namespace

Report correct_across(Newton& newton, State& state, const Eigen::MatrixXd& held, const State* from, int most, Plane& across,
                      const std::function<bool(const State&)>& lies_on) {
  const bool resolved = resolves_load(newton, state);
  Report report;
  for (int k = 0; k < (resolved ? 1 : arc::most_rounds); ++k, from = nullptr) {
    report = newton.correct(state, held, from, resolved ? most : arc::few_iterations, &across);
    if (report.status != Status::not_converged) return report;
    State fixed = state;
    if (!lies_on(fixed)) continue;
    const Report at_load = newton.correct(fixed, held, nullptr, most);
    if (!at_load.converged() || !lies_on(fixed)) continue;
    state = std::move(fixed);
    return at_load;
  }
  return report;
}

// Steps that rounding turns are none.
Report Arc::on_plane(State& state, const Eigen::MatrixXd& held, const State* from) const {
  Plane across = plane();
  const double wanted = position(state), here = from_.point.state.load_factor;
  return correct_across(newton_, state, held, from, arc::most_iterations, across, [&](const State& at) {
    return std::abs(position(at) - wanted) <= arc::off_plane * std::abs(wanted) &&
           std::abs(at.load_factor - here) > arc::resolved * epsilon * std::max(std::abs(here), std::abs(at.load_factor));
  });
}

Equilibrium with_tangent(Newton& newton, Equilibrium e, const Equilibrium& nearest, const Plane& across) {
  if (e.tangent.size() == 0) return e;
  Factors& factors = newton.factors();
  if (nearest.zero_modes.cols() > 0 || e.zero_modes.cols() > 0)
    factors.factorize_holding(phase_conditions(newton.energy(), e.point.state, e.zero_modes.cols() == nearest.zero_modes.cols() ? e.zero_modes : nearest.zero_modes));
  const Factors::Bordered t = factors.solve_bordered(newton.energy().load_derivative(), across.row, across.corner, Vector::Zero(e.tangent.size()), 1);
  const double least = epsilon * epsilon * t.p.norm() * across.load / across.length;
  const double load = std::abs(t.delta) > least ? t.delta : std::copysign(least, t.delta);
  if (t.p.allFinite() && std::isfinite(1 / load)) e.tangent = t.p / load;
  return e;
}

double Arc::load_rate(const Equilibrium& e) const {
  const Direction d = along(e);
  return d.load / std::max(cosine(d, direction_, metric_), arc::least_cosine);
}

// A column that is all but free to spin about its line is spun by the forces that are out of balance on the way: then its motions as a rigid part are held there, and
// follow at the end.
Equilibrium Arc::at(double s, const Equilibrium& nearest) const {
  State state;
  Report report = correct(state, s, nearest);
  if (report.status == Status::not_converged && nearest.zero_modes.cols() == 0) {
    Equilibrium held = nearest;
    held.zero_modes = free_motions(newton_.energy(), nearest.point.state);
    if (held.zero_modes.cols() > 0 && correct(state, s, held).converged()) report = settle(state, {});
  }
  if (!report.converged()) {
    Equilibrium failed;
    failed.point.state = state, failed.point.report = report;
    return failed;
  }
  return with_tangent(newton_, assess(newton_, state, report), nearest, plane());
}

}  // namespace elamin
