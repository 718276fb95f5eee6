#include "solve/newton.hpp"

#include "core/dense.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "solve/limits.hpp"
#include "solve/steady_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace elamin {

namespace {

// Whether the residual of a search that is to stay on its branch has halved lately, or every step was at most half of the one before: where the overlap of a stiff
// contact is all that bears a force, it shrinks, and stays the whole residual. A search that has left its branch falls, and what it finds is of no use.
bool contracts(const std::vector<Iteration>& history) {
  if (static_cast<int>(history.size()) <= limits::patience_on_branch) return true;
  const auto lately = history.end() - limits::patience_on_branch;
  const auto by_residual = [](const Iteration& a, const Iteration& b) { return a.residual < b.residual; };
  if (std::min_element(lately, history.end(), by_residual)->residual <= std::min_element(history.begin(), lately, by_residual)->residual / 2) return true;
  return std::adjacent_find(lately, history.end(), [](const Iteration& a, const Iteration& b) { return b.step > a.step / 2; }) == history.end();
}

// Whether contacts bear forces.
bool touches(const EnergyTerms& terms) { return terms.contact != 0 || terms.wall != 0 || terms.body != 0; }

std::string below(double tolerance) { return fmt::format("the residual is below {:g}", tolerance); }

}  // namespace

Newton::Newton(Energy& energy, NewtonOptions options)
    : energy_(energy), options_(options), factors_(energy), extent_(extent(energy.model())) {}

// What a run costs, from here on.
class Newton::Effort {
 public:
  explicit Effort(const Factors& factors) : factors_(factors), before_(factors.factorizations()), seconds_before_(factors.seconds()) {}
  void tell(Report& report) const {
    report.factorizations = factors_.factorizations() - before_;
    report.seconds = watch_.seconds(), report.factor_seconds = factors_.seconds() - seconds_before_;
  }

 private:
  const Factors& factors_;
  const int before_;
  const double seconds_before_;
  const Stopwatch watch_;
};

double Newton::residual() const { return energy_.relative(energy_.gradient()); }

void Newton::record(Report& report, double step, double shift) const {
  report.energy = energy_.last_terms().total();
  report.residual = residual();
  report.history.push_back({report.energy, report.residual, step, shift});
  at_iteration(report.iterations, report.residual);
}

Report Newton::finish(const State& state, Report report, const Halt& halt) {
  energy_.be_at(state);
  report.energy = energy_.last_terms().total(), report.residual = residual();
  report.status = halt.status, report.why = halt.why;
  return report;
}

std::optional<Newton::Halt> Newton::must_halt(const State& state, const Report& report, int most) const {
  if (!std::isfinite(energy_.last_terms().total()))
    return Halt{Status::not_converged, "the energy is not finite here: particles coincide, or do not fit into a curved wall"};
  if (interrupted()) return Halt{Status::interrupted, "interrupted"};
  if (const std::string gone = escaped(energy_.model(), state, limits::lost * extent_); !gone.empty())
    return Halt{Status::not_converged, gone};
  most = std::min(most, options_.max_iterations);
  if (report.iterations < most) return {};
  const std::string grain = falling(energy_);
  return Halt{Status::not_converged, fmt::format("{} iterations were not enough{}; the residual is {:.2g}{}", most,
                                                 most == options_.max_iterations ? ", a larger solver.max_iterations may do" : "",
                                                 report.residual, grain.empty() ? "" : "; " + grain + " flies freely under a force")};
}

// What no shift makes a factor of.
std::optional<Newton::Halt> Newton::no_factor() const {
  std::string why = factors_.why_none();
  if (why.empty()) return {};
  return Halt{interrupted() ? Status::interrupted : Status::not_converged, std::move(why)};
}

Newton::Halt Newton::without_factor() const { return no_factor().value_or(Halt{Status::not_converged, "no shift makes a factor of the Hessian"}); }

// The residual down to rounding: simplified Newton steps with the factor at hand. They are kept while the residual halves, or, where it is rounding already, while the
// steps halve: what is soft moves by more than the residual tells. step: makes one, and gives its size [length].
void Newton::polish(State& state, Report& report, const std::function<double(State&)>& step) {
  const bool meets = may_touch(energy_.model());
  double last = infinity;
  for (int k = 0; k < limits::most_polishing && report.residual > (meets ? 4 : limits::exact) * epsilon; ++k) {
    State next = state;
    const double size = step(next);
    energy_.evaluate(next, false);
    ++report.evaluations;
    const bool is_rounding = !meets && report.residual <= limits::finest && residual() <= limits::finest;
    if (!(residual() <= report.residual / 2) && !(is_rounding && size <= last / 2)) break;
    state = next, last = size;
    report.residual = residual();
  }
}

Newton::Halt Newton::a_minimum() const { return {Status::converged, below(options_.tolerance) + " and the Hessian has no negative eigenvalue"}; }

Report Newton::minimise(State& state, Pace pace, int most) {
  const Effort effort(factors_);
  Descent descent{.pace = pace, .most = most, .step_bound = extent_};
  int& iterations = descent.report.iterations;                  // max_iterations are from the last saddle on, `most` in all
  int before = 0, saddles = 0;
  std::optional<Halt> halt;
  while (!(halt = iterate(state, descent))) {
    ++iterations;
    const bool saddle = descent.left && descent.report.residual <= options_.tolerance;
    if (saddle && ++saddles <= limits::most_saddles) before += iterations, descent.most -= std::exchange(iterations, 0);
  }
  iterations += before;
  effort.tell(descent.report);
  if (descent.settled_at && halt->status == Status::not_converged) state = *descent.settled_at, halt = a_minimum();
  if (halt->status == Status::not_converged)
    if (const std::string what = obstacle(energy_, state); !what.empty()) halt->why += "; " + what;
  return finish(state, descent.report, *halt);
}

// One iteration: look where the state is, end there if it is a minimum; else a convex model, its step, and as much of it as goes down.
std::optional<Newton::Halt> Newton::iterate(State& state, Descent& descent) {
  look(state, descent);
  const bool settled = descent.report.residual <= options_.tolerance;
  if (std::isfinite(descent.report.energy))
    if (const auto halt = no_factor()) return halt;
  const bool stays = descent.pace == Pace::stationary;
  bool bends = false;
  if (settled) {
    const bool minimum = is_minimum(state, descent);
    if (stays) return Halt{Status::converged, below(options_.tolerance)};
    bends = minimum && still_bends(state, descent);
    if (minimum && !bends) return a_minimum();
  }
  if (const auto halt = must_halt(state, descent.report, descent.most)) return halt;
  if (stays && (descent.rises >= limits::most_rises || !contracts(descent.report.history)))
    return Halt{Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", descent.report.residual)};

  const Vector g = energy_.gradient();
  steady_bodies(energy_, g);
  bool left;
  const std::optional<double> convex = make_convex(state, g, descent, settled, left);
  if (!convex) return without_factor();
  descent.shift = *convex;
  if (left) {
    descent.left = true, descent.linearised = false, descent.settled_at.reset();
    return {};
  }
  if (settled && !bends) return Halt{Status::not_converged, "a saddle could not be left along its negative curvature"};
  std::optional<Step> step = step_within(descent.step_bound, g, descent.shift);
  if (!step) return without_factor();
  if (!resolve_softest(g, descent, *step)) return without_factor();
  return advance(state, descent, std::move(*step));
}

void Newton::look(const State& state, Descent& descent) {
  const double before = descent.report.residual;
  energy_.evaluate(state, true, {.from = descent.from()});
  ++descent.report.evaluations;
  record(descent.report, descent.moved, descent.shift);
  descent.rises = descent.eased && descent.report.residual > before ? descent.rises + 1 : 0;
}

// Whether a state with a small residual is a minimum; then its residual is taken down to rounding.
bool Newton::is_minimum(State& state, Descent& descent) {
  if (descent.linearised) energy_.evaluate(state);
  Inertia inertia = factors_.inertia();
  const auto by_factor = [&](State& next) {
    const Vector p = factors_.cholesky().solve(energy_.gradient());
    return energy_.kinematics().retract(next, p, -1), infinity_norm(p);
  };
  if (inertia.negative > 0 && factors_.make_positive(0)) {
    // The forces that are left may tilt a motion that costs nothing: what remains without them counts.
    const double before = descent.report.residual;
    polish(state, descent.report, by_factor);
    energy_.evaluate(state);
    if (descent.report.residual < before) inertia = factors_.inertia();
  }
  descent.report.negative = inertia.negative;
  if (inertia.negative > 0) return false;
  // With a zero mode the exact factor would fill the steps with its rounding.
  if (factors_.make_positive_from(inertia.zero > 0 ? limits::hold_zero_modes * factors_.zero_level() : 0.0))
    polish(state, descent.report, by_factor);
  return true;
}

// Whether the forces that are left at a minimum, below the tolerance, would still bend the structure: then they may be all that tells how far it has buckled, and
// Newton's method goes on as long as it halves them. Else the state is the best so far. Where contacts bear forces, what is left is rounding.
bool Newton::still_bends(State& state, Descent& descent) {
  const double residual = descent.report.residual, least = descent.settled_at ? descent.least : infinity;
  if (residual > least) state = *descent.settled_at;
  if (residual <= limits::sharp || residual > least / 2) return false;
  energy_.evaluate(state);
  if (touches(energy_.last_terms()) || !factors_.make_positive_from(0)) return false;
  if (distortion(energy_, state, factors_.cholesky().solve(energy_.gradient())) <= limits::unbent) return false;
  descent.settled_at = state, descent.least = residual, descent.linearised = false;
  return true;
}

// How far the state may go along a step, before anything is asked of the energy.
Newton::Part Newton::part_of(const State& state, const Step& step) const {
  const double rotation = part_within_rotation(state, step.p), free = free_part(state, step.p, rotation);
  return {rotation * free, free};
}

// Takes as much of the step as goes down, halving it; where rounding hides the energy's change and the Hessian itself is convex, Newton's step
// itself is the best there is.
std::optional<Newton::Halt> Newton::advance(State& state, Descent& descent, Step step) {
  Part part = part_of(state, step);
  double alpha = part.first;
  State next;
  const bool hidden = !descent.eased && std::abs(step.slope) <= step.energy_rounding &&
                      descent.shift <= limits::hold_zero_modes * factors_.zero_level() && ++descent.unseen <= limits::most_unseen;
  if (hidden) {
    next = state;
    energy_.kinematics().retract(next, step.p, alpha);
  }
  while (!hidden && !take(state, step, alpha, descent.pace, next)) {
    ++descent.report.evaluations;
    if (interrupted()) return Halt{Status::interrupted, "interrupted"};
    alpha /= 2;
    const bool bodies = !energy_.model().bodies.empty();
    if (bodies && alpha < limits::shortest_part * part.first && alpha * infinity_norm(step.p) > 1e-12 * extent_) {
      const std::optional<Step> bent = shorter_step(state, descent, step, alpha);
      if (!bent) return without_factor();
      step = *bent, part = part_of(state, step), alpha = part.first;
      continue;
    }
    const bool nothing = !(alpha > limits::least_part * part.first);             // or where nothing of the step is free
    if (nothing && std::exchange(descent.eased, false)) return descent.refused = true, std::nullopt;
    if (nothing)
      return Halt{Status::not_converged, fmt::format("no step lowers the {}; the residual stays at {:.2g}",
          std::abs(step.slope) <= step.energy_rounding ? "residual, whose changes are rounding; a larger solver.tolerance may do" : "energy",
          descent.report.residual)};
  }
  descent.moved = alpha * infinity_norm(step.p);
  descent.step_bound = part.free < 0.5 ? std::min(descent.step_bound, 2 * part.first * infinity_norm(step.p))
                                  : std::min(std::max(descent.step_bound, 4 * descent.moved), extent_);
  descent.previous = state;
  descent.linearised = descent.pace != Pace::downhill;
  state = next;
  return {};
}

// Contacts of bodies open and close on the way: a shorter step, bent to where they are stiff, instead of a small part of a long one.
std::optional<Newton::Step> Newton::shorter_step(const State& state, Descent& descent, const Step& step, double alpha) {
  descent.step_bound = alpha * infinity_norm(step.p);
  energy_.evaluate(state, true, {.from = descent.from()});
  steady_bodies(energy_, step.g);
  if (!factors_.make_positive_from(descent.shift)) return {};
  return step_within(descent.step_bound, step.g, descent.shift);
}

Report Newton::correct(State& state, const Eigen::MatrixXd& held, const State* from, int most, Plane* plane) {
  const Effort effort(factors_);
  const Kinematics& kinematics = energy_.kinematics();
  Report report;
  const bool guided = plane && plane->guided && held.cols() > 0;
  const auto free_gradient = [&]() -> Vector {                  // without what guides
    const Vector& g = energy_.gradient();
    return guided ? Vector(g - held * (held.transpose() * g)) : g;
  };
  std::optional<State> settled_at;                              // the best so far …
  double least = 0;                                             // … and its residual
  const auto end = [&](Status status, std::string why) {
    if (settled_at && status == Status::not_converged) {
      state = *settled_at, status = Status::converged, why = below(options_.tolerance);
    }
    effort.tell(report);
    report = finish(state, report, {status, std::move(why)});
    report.residual = energy_.relative(free_gradient());
    return report;
  };
  Vector column;                                                // ∂g/∂λ
  double off = 0;                                               // the plane's condition
  const auto see = [&](const State& at) {
    if (plane && plane->condition) off = plane->condition(at, *plane);
  };
  const auto correction = [&]() -> Factors::Bordered {          // with the factor at hand, from the last evaluation
    const Vector g = factors_.gradient();
    if (!plane) return {-factors_.solve_holding(g), 0.0};
    return factors_.solve_bordered(column, plane->row, plane->corner, -g, -off);
  };
  const auto move = [&](State& to, const Factors::Bordered& step, double part) {
    if (plane) kinematics.prescribe(to, to.load_factor + part * step.delta);
    kinematics.retract(to, step.p, part);
  };
  // λ + δ is rounded to a double, and half a spacing of doubles stretches what is driven by more than rounding. So p is that for the change δ that λ really takes:
  //   H p = −g − c δ.
  const bool meets = may_touch(energy_.model());
  const auto rounded_correction = [&](const State& at) {
    const Factors::Bordered step = correction();
    if (!plane || meets) return step;
    const double taken = (at.load_factor + step.delta) - at.load_factor;
    const Vector p = -factors_.solve_holding(factors_.gradient() + taken * column);
    return distortion(energy_, at, p - step.p) <= limits::unbent ? Factors::Bordered{p, taken} : step;
  };
  State previous;
  std::vector<double> sizes;                                    // of every correction
  double before_step = 0;                                       // the residual
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, {.from = from});
    ++report.evaluations;
    record(report, moved, 0);
    if (guided) report.residual = energy_.relative(free_gradient());
    see(state);
    // A residual that bounces comes below the tolerance by chance, as behind a limit point where a contact has hardly closed: there is no equilibrium.
    const bool bounces = !settled_at && report.iterations > 0 && report.residual > std::max(limits::sharp, limits::contracting * before_step) && touches(energy_.last_terms());
    const bool settled = report.residual <= options_.tolerance && std::abs(off) <= (plane ? plane->close : 0.0) && !bounces;
    before_step = report.residual;
    if (!settled || !std::isfinite(report.energy))
      if (const auto halt = must_halt(state, report, most)) return end(halt->status, halt->why);
    if (!factors_.factorize_resolving(held)) {
      const Halt halt = without_factor();
      return end(halt.status, halt.why);
    }
    if (plane) column = energy_.load_derivative();
    if (settled) {
      const double before = report.residual;
      if (!guided)
        polish(state, report, [&](State& next) {
          see(next);
          const Factors::Bordered step = rounded_correction(next);
          return move(next, step, 1), infinity_norm(step.p);
        });
      // Where contacts bear forces, their stiffness changes with every step, and what is left is rounding; not after a step so short that its forces were below the
      // tolerance to begin with, and a place where one is made or lost is found exactly.
      const bool finer = (plane && plane->condition) || (report.iterations == 0 && !energy_.slack());
      if (guided || (touches(energy_.last_terms()) && !finer) || report.residual <= limits::sharp || (settled_at && report.residual > least / 2)) {
        if (settled_at && report.residual > least) state = *settled_at;
        return end(Status::converged, below(options_.tolerance));
      }
      // Else, where it would still bend the structure, it may be all that tells one branch from another, or, where something may touch, whether it
      // does: then on, as long as that halves it.
      energy_.be_at(state), see(state);
      const Factors::Bordered left = correction();
      if (!meets && distortion(energy_, state, left.p, left.delta) <= limits::unbent)
        return end(Status::converged, below(options_.tolerance));
      settled_at = state, least = report.residual;
      if (least < before) continue;
    }
    const Factors::Bordered step = correction();
    sizes.push_back(plane ? std::hypot(step.p.norm() / plane->length, step.delta / plane->load) : step.p.norm());
    const std::size_t k = sizes.size() - 1;
    if (!step.p.allFinite() || !std::isfinite(step.delta) || (k >= 4 && !(sizes[k] < sizes[k - 2])))
      return end(Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", report.residual));
    const double rotation = part_within_rotation(state, step.p, step.delta), alpha = rotation * free_part(state, step.p, rotation);
    moved = alpha * infinity_norm(step.p);
    previous = state;
    from = &previous;
    move(state, step, alpha);
  }
}

}  // namespace elamin
