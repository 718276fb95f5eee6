#include "solve/newton.hpp"

#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "energy/step_limits.hpp"
#include "solve/steady_bodies.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {

namespace {

constexpr int most_unseen = 12;
constexpr double shortest_part = 1.0 / 32;    // of a step of rigid bodies
constexpr double lost = 100;                  // extents of the structure: what is that far away comes back no more

double infinity_norm(const Vector& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

Newton::Newton(Energy& energy, NewtonOptions options)
    : energy_(energy), options_(options), factors_(energy), extent_(extent(energy.model())) {}

double Newton::residual() const { return energy_.relative(energy_.gradient()); }

void Newton::record(Report& report, double step, double shift) const {
  report.energy = energy_.last_terms().total();
  report.residual = residual();
  report.history.push_back({report.energy, report.residual, step, shift});
}

Report Newton::finish(const State& state, Report report, const Halt& halt) {
  energy_.evaluate(state);
  report.energy = energy_.last_terms().total(), report.residual = residual();
  report.status = halt.status, report.why = halt.why;
  return report;
}

std::optional<Newton::Halt> Newton::must_halt(const State& state, const Report& report, int most) const {
  if (!std::isfinite(energy_.last_terms().total()))
    return Halt{Status::not_converged, "the energy is not finite here: particles coincide, or do not fit into a curved wall"};
  if (interrupted()) return Halt{Status::interrupted, "interrupted"};
  if (const std::string gone = escaped(energy_.model(), state, lost * extent_); !gone.empty())
    return Halt{Status::not_converged, gone + " moves away without end; hold it with a [[support]], or with a wall"};
  most = std::min(most, options_.max_iterations);
  if (report.iterations < most) return {};
  const std::string grain = falling(energy_);
  return Halt{Status::not_converged, fmt::format("{} iterations were not enough{}; the residual is {:.2g}{}", most,
                                                 most == options_.max_iterations ? ", a larger solver.max_iterations may do" : "",
                                                 report.residual, grain.empty() ? "" : "; " + grain + " flies freely under a force")};
}

// The residual down to rounding: simplified Newton steps with the factor at hand, kept while they halve the residual.
void Newton::polish(State& state, Report& report, const std::function<void(State&)>& step) {
  constexpr int most_polishing = 4;
  for (int k = 0; k < most_polishing && report.residual > 4 * epsilon; ++k) {
    State next = state;
    step(next);
    energy_.evaluate(next, false);
    ++report.evaluations;
    if (!(residual() <= report.residual / 2)) break;
    state = next;
    report.residual = residual();
  }
}

Report Newton::minimise(State& state, Pace pace, int most) {
  const Stopwatch watch;
  Report report;
  const int factorizations_before = factors_.factorizations();
  const double factor_seconds_before = factors_.seconds();
  const auto end = [&](Status status, std::string why) {
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds(), report.factor_seconds = factors_.seconds() - factor_seconds_before;
    if (status == Status::not_converged)
      if (const std::string what = obstacle(energy_, state); !what.empty()) why += "; " + what;
    return finish(state, report, {status, std::move(why)});
  };
  double shift = 0;                                             // the last one: a guess for the next
  double reach = extent_;                                       // of a step, as far as the last ones could be taken
  int unseen = 0;                                               // steps whose change of energy rounding hid
  State previous;
  bool linearised = false;                                      // previous holds where the last step came from
  const bool rigid = !energy_.model().bodies.empty();
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, linearised ? &previous : nullptr);
    ++report.evaluations;
    record(report, moved, shift);
    const bool settled = report.residual <= options_.tolerance;
    if (settled) {
      if (linearised) energy_.evaluate(state);
      const Inertia inertia = factors_.inertia();
      report.negative = inertia.negative;
      if (inertia.negative == 0) {
        // With a zero mode the exact factor would fill the steps with its rounding.
        factors_.try_cholesky(inertia.zero > 0 ? 100 * factors_.zero_level() : 0.0);
        polish(state, report, [&](State& next) {
          energy_.kinematics().retract(next, factors_.cholesky().solve(energy_.gradient()), -1);
        });
        return end(Status::converged, fmt::format("the residual is below {:g} and the Hessian has no negative eigenvalue", options_.tolerance));
      }
    }
    if (const auto halt = must_halt(state, report, most)) return end(halt->status, halt->why);

    const Vector g = energy_.gradient();
    steady_bodies(energy_, g);
    bool left;
    shift = make_convex(state, g, shift, settled, left);
    if (left) {
      linearised = false;
      continue;
    }
    if (settled) return end(Status::not_converged, "a saddle could not be left along its negative curvature");
    Step step = step_within(reach, g, shift);
    double turn = part_within_turn(state, step.p), free = free_part(state, step.p, turn), first = turn * free, alpha = first;
    State next;
    // Where rounding hides the energy's change and the model is convex, Newton's step itself is the best there is.
    const bool hidden = std::abs(step.slope) <= step.energy_rounding && shift <= 100 * factors_.zero_level() && ++unseen <= most_unseen;
    if (hidden) {
      next = state;
      energy_.kinematics().retract(next, step.p, alpha);
    }
    while (!hidden && !take(state, step, alpha, pace, next)) {
      ++report.evaluations;
      alpha /= 2;
      if (rigid && alpha < shortest_part * first && alpha * infinity_norm(step.p) > 1e-12 * extent_) {
        // Contacts open and close on the way: a shorter step, bent to where they are stiff, instead of a small part of a long one.
        reach = alpha * infinity_norm(step.p);
        energy_.evaluate(state, true, linearised ? &previous : nullptr);
        steady_bodies(energy_, g);
        factors_.try_cholesky(shift);
        step = step_within(reach, g, shift);
        turn = part_within_turn(state, step.p), free = free_part(state, step.p, turn), alpha = first = turn * free;
        continue;
      }
      if (!(alpha > 1e-12 * first))
        return end(Status::not_converged, fmt::format("no step lowers the {}; the residual stays at {:.2g}",
            std::abs(step.slope) <= step.energy_rounding ? "residual, whose changes are rounding; a larger solver.tolerance may do" : "energy",
            report.residual));
    }
    moved = alpha * infinity_norm(step.p);
    reach = free < 0.5 ? std::min(reach, 2 * first * infinity_norm(step.p)) : std::min(std::max(reach, 4 * moved), extent_);
    previous = state;
    linearised = pace == Pace::long_steps;
    state = next;
  }
}

Report Newton::correct(State& state, const Eigen::MatrixXd& held, const State* from, int most, Plane* plane) {
  const Stopwatch watch;
  const Kinematics& kinematics = energy_.kinematics();
  Report report;
  const int factorizations_before = factors_.factorizations();
  const double factor_seconds_before = factors_.seconds();
  const bool guided = plane && plane->guided && held.cols() > 0;
  const auto free_gradient = [&]() -> Vector {                  // without what guides
    const Vector& g = energy_.gradient();
    return guided ? Vector(g - held * (held.transpose() * g)) : g;
  };
  const auto end = [&](Status status, std::string why) {
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds(), report.factor_seconds = factors_.seconds() - factor_seconds_before;
    report = finish(state, report, {status, std::move(why)});
    report.residual = energy_.relative(free_gradient());
    return report;
  };
  Vector column;                                                // ∂g/∂λ
  double off = 0;                                               // the plane's condition
  const auto look = [&](const State& at) {
    if (plane && plane->condition) off = plane->condition(at, *plane);
  };
  const auto solve = [&](const Vector& g) -> Factors::Bordered {
    if (!plane) return {-factors_.solve_holding(g), 0.0};
    return factors_.solve_bordered(column, plane->row, plane->corner, -g, -off);
  };
  const auto move = [&](State& to, const Factors::Bordered& step, double part) {
    if (plane) kinematics.prescribe(to, to.load_factor + part * step.delta);
    kinematics.retract(to, step.p, part);
  };
  State previous;
  std::vector<double> sizes;                                    // of every correction
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, from);
    ++report.evaluations;
    record(report, moved, 0);
    if (guided) report.residual = energy_.relative(free_gradient());
    look(state);
    const bool settled = report.residual <= options_.tolerance && std::abs(off) <= (plane ? plane->close : 0.0);
    if (!settled || !std::isfinite(report.energy))
      if (const auto halt = must_halt(state, report, most)) return end(halt->status, halt->why);
    factors_.factorize_holding(held);
    if (plane) column = energy_.load_derivative();
    if (settled) {
      if (!guided) polish(state, report, [&](State& next) { look(next), move(next, solve(energy_.gradient()), 1); });
      return end(Status::converged, fmt::format("the residual is below {:g}", options_.tolerance));
    }
    const Factors::Bordered step = solve(energy_.gradient());
    sizes.push_back(plane ? std::hypot(step.p.norm() / plane->length, step.delta / plane->load) : step.p.norm());
    const std::size_t k = sizes.size() - 1;
    if (!step.p.allFinite() || !std::isfinite(step.delta) || (k >= 4 && !(sizes[k] < sizes[k - 2])))
      return end(Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", report.residual));
    const double turn = part_within_turn(state, step.p, step.delta), alpha = turn * free_part(state, step.p, turn);
    moved = alpha * infinity_norm(step.p);
    previous = state;
    from = &previous;
    move(state, step, alpha);
  }
}

}  // namespace elamin
