#include "solve/newton.hpp"

#include "core/interrupt.hpp"
#include "core/timing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace elamin {

namespace {

constexpr double largest_turn = 0.3;          // of a bond in one step: rotations stay within the series' reach
constexpr double armijo = 0.1;                // part of the predicted decrease that must come true
constexpr int most_corrections = 6;
constexpr int most_unseen = 12;
constexpr double contraction = 0.7;           // corrections must shrink at least so, or the step is too long
constexpr double lost = 100;                  // extents of the structure: what is that far away comes back no more

double infinity_norm(const Vector& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

// A step p = −M⁻¹g + (a direction of negative curvature), M = H + τI, with what the model predicts along it.
struct Newton::Step {
  Vector p, g, hp;             // hp = H p
  double energy, slope, curvature;
  double energy_rounding = 0;
  bool keep_direction = false; // corrections stay orthogonal to p: along a soft p they would overshoot
  double predicted(double alpha) const { return alpha * slope + alpha * alpha / 2 * curvature; }
  /// Rounding hides the change of energy that the step would make.
  bool hidden(double alpha) const { return std::abs(predicted(alpha)) <= energy_rounding; }
};

// Why a run ends.
struct Newton::Halt {
  Status status;
  std::string why;
};

Newton::Newton(Energy& energy, NewtonOptions options) : energy_(energy), options_(options), factors_(energy) {}

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

std::optional<Newton::Halt> Newton::must_halt(const State& state, const Report& report) const {
  if (!std::isfinite(energy_.last_terms().total()))
    return Halt{Status::not_converged, "the energy is not finite here: particles coincide, or do not fit into a curved wall"};
  if (interrupted()) return Halt{Status::interrupted, "interrupted"};
  if (const std::string gone = energy_.escaped(state, lost); !gone.empty())
    return Halt{Status::not_converged, gone + " moves away without end; hold it with a [[support]], or with a wall"};
  if (report.iterations < options_.max_iterations) return {};
  const std::string falls = energy_.falling();
  return Halt{Status::not_converged, fmt::format("{} iterations were not enough; the residual is {:.2g}{}", options_.max_iterations,
                                                 report.residual, falls.empty() ? "" : "; " + falls + " flies freely under a force")};
}

// The part of p that one step may take: turns within reach, nothing longer than the whole …
double Newton::part_within_turn(const State& state, const Vector& p) const {
  constexpr double tiny = std::numeric_limits<double>::min();
  return std::min({1.0, largest_turn / std::max(energy_.distortion(state, p), tiny),
                   energy_.longest_step() / std::max(infinity_norm(p), tiny)});
}

// … and nothing through anything: the part of part · p.
double Newton::free_part(const State& state, const Vector& p, double part) const {
  State to = state;
  energy_.kinematics().retract(to, p, part);
  return energy_.passage(state, to);
}

// The step with the factor of H + shift I at hand, from the last evaluation.
Newton::Step Newton::newton_step(const Vector& g, double shift) {
  Step step;
  step.g = g;
  step.p = -factors_.cholesky().solve(g);
  step.hp = -g - shift * step.p;
  step.energy = energy_.last_terms().total();
  step.slope = g.dot(step.p), step.curvature = step.p.dot(step.hp);
  step.energy_rounding = 16 * epsilon * energy_.last_terms().size();
  return step;
}

bool Newton::take(const State& from, const Step& step, double alpha, Pace pace, State& to) {
  to = from;
  energy_.kinematics().retract(to, step.p, alpha);
  return pace == Pace::downhill ? take_downhill(from, step, alpha, to) : take_long(from, step, alpha, to);
}

// A long step is good if the energy falls but for what was not predicted of it; where rounding hides the energy, if
// the residual falls.
bool Newton::take_long(const State& from, const Step& step, double alpha, State& to) {
  energy_.evaluate(to, false);
  const double change = energy_.last_terms().total() - step.energy;
  if (!std::isfinite(change)) return false;
  if (step.hidden(alpha)) return infinity_norm(energy_.gradient()) < 0.9 * infinity_norm(step.g);
  const double wanted = armijo * step.predicted(alpha);
  return change <= wanted || change - energy_.unpredicted(to, from) <= wanted;
}

// Downhill the energy itself must fall; simplified Newton corrections bend a step back that stretched the structure.
bool Newton::take_downhill(const State& from, const Step& step, double alpha, State& to) {
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0;; ++k) {
    energy_.evaluate(to, false);
    const double change = energy_.last_terms().total() - step.energy;
    if (!std::isfinite(change)) return false;
    const bool falls = step.hidden(alpha) ? infinity_norm(energy_.gradient()) < 0.9 * infinity_norm(step.g)
                                          : change <= armijo * step.predicted(alpha);
    if (falls) return k == 0 || energy_.passage(from, to) == 1;
    Vector correction = -factors_.cholesky().solve(Vector(energy_.gradient() - step.g - alpha * step.hp));
    if (step.keep_direction) correction -= step.p * (step.p.dot(correction) / step.p.squaredNorm());
    const double size = correction.norm();
    if (!(size <= contraction * last) || k == most_corrections) return false;
    last = size;
    energy_.kinematics().retract(to, correction);
  }
}

// The residual down to rounding: simplified Newton steps with the factor at hand, kept while they halve the residual.
void Newton::polish(State& state, Report& report, const std::function<Vector(const Vector&)>& solve) {
  constexpr int most = 4;
  for (int k = 0; k < most && report.residual > 4 * epsilon; ++k) {
    State next = state;
    energy_.kinematics().retract(next, solve(energy_.gradient()), -1);
    energy_.evaluate(next, false);
    ++report.evaluations;
    if (!(residual() <= report.residual / 2)) break;
    state = next;
    report.residual = residual();
  }
}

// Leaves a factor of H + τI, positive definite, and returns τ. Where H is indefinite τ is of the size of its lowest
// eigenvalue; a state that has no slope along that mode is moved off the saddle instead (`left`).
double Newton::make_convex(State& state, const Vector& g, double guess, bool settled, bool& left) {
  left = false;
  double shift = factors_.make_positive(guess / 4);
  const double sigma = factors_.zero_level();
  if (shift > sigma) {
    const EigenPairs lowest = settled ? factors_.lowest(1, shift) : factors_.lowest(1, shift, 0.1);
    if (settled || std::abs(lowest.vectors.col(0).dot(g)) <= 1e-6 * g.norm()) {
      left = leave_saddle(state, lowest.vectors.col(0));
      if (left) return std::abs(lowest.values[0]);
      energy_.evaluate(state);
    }
    shift = -2 * lowest.values[0];
    while (!factors_.try_cholesky(shift)) shift *= 2;
  } else if (shift > 0) {                                       // a zero mode: rounding alone would fill the step with it
    shift = 100 * sigma;
    factors_.try_cholesky(shift);
  }
  return shift;
}

// The Newton step, with a shift τ so large that no dof moves by more than about `reach`: along a direction that has a force
// but hardly a stiffness, as of a grain that must slide, the step would be of no use however it is cut.
Newton::Step Newton::step_within(double reach, const Vector& g, double& shift) {
  Step step = newton_step(g, shift);
  while (infinity_norm(step.p) > 2 * reach) {
    shift = std::max(4 * shift, infinity_norm(g) / (4 * reach));
    if (!factors_.try_cholesky(shift)) continue;
    step = newton_step(g, shift);
  }
  return step;
}

Report Newton::minimise(State& state, Pace pace) {
  const Stopwatch watch;
  Report report;
  const int factorizations_before = factors_.factorizations();
  const double factor_seconds_before = factors_.seconds();
  const auto end = [&](Status status, std::string why) {
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds(), report.factor_seconds = factors_.seconds() - factor_seconds_before;
    return finish(state, report, {status, std::move(why)});
  };
  double shift = 0;                                             // the last one: a guess for the next
  double reach = energy_.longest_step();                        // of a step, as far as the last ones could be taken
  int unseen = 0;                                               // steps whose change of energy rounding hid
  State previous;
  bool linearised = false;                                      // previous holds where the last step came from
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
        polish(state, report, [&](const Vector& g) { return factors_.cholesky().solve(g); });
        return end(Status::converged, fmt::format("the residual is below {:g} and the Hessian has no negative eigenvalue", options_.tolerance));
      }
    }
    if (const auto halt = must_halt(state, report)) return end(halt->status, halt->why);

    const Vector g = energy_.gradient();
    bool left;
    shift = make_convex(state, g, shift, settled, left);
    if (left) {
      linearised = false;
      continue;
    }
    if (settled) return end(Status::not_converged, "a saddle could not be left along its negative curvature");
    const Step step = step_within(reach, g, shift);
    const double turn = part_within_turn(state, step.p), free = free_part(state, step.p, turn), first = turn * free;
    double alpha = first;
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
      if (alpha < 1e-12 * first)
        return end(Status::not_converged, fmt::format("no step lowers the {}; the residual stays at {:.2g}",
            std::abs(step.slope) <= step.energy_rounding ? "residual below rounding" : "energy", report.residual));
    }
    moved = alpha * infinity_norm(step.p);
    reach = free < 0.5 ? std::min(reach, 2 * first * infinity_norm(step.p)) : std::min(std::max(reach, 4 * moved), energy_.longest_step());
    previous = state;
    linearised = pace == Pace::long_steps;
    state = next;
  }
}

bool Newton::leave_saddle(State& state, const Vector& direction) {
  energy_.evaluate(state);
  const double shift = std::max(-2 * energy_.quadratic_form(direction) / direction.squaredNorm(), 0.0);
  for (double s = shift; !factors_.try_cholesky(s); s = std::max(2 * s, factors_.zero_level())) {}
  Step step;
  const double turn = energy_.distortion(state, direction), unit = turn > 0 ? turn : energy_.movement(direction);
  if (!(unit > 0)) return false;
  step.p = direction / unit;
  step.g = energy_.gradient();
  if (step.g.dot(step.p) > 0 && step.g.norm() > 0 && residual() > options_.tolerance) step.p = -step.p;
  step.hp = energy_.multiply(step.p);
  step.energy = energy_.last_terms().total();
  step.slope = std::min(0.0, step.g.dot(step.p)), step.curvature = energy_.quadratic_form(step.p);
  step.keep_direction = true;
  if (!(step.curvature < 0)) return false;
  const double farthest = free_part(state, step.p, largest_turn) * largest_turn;
  State best = state, next;
  double lowest = step.energy;
  bool left = false;
  for (double alpha = 1e-3; alpha <= farthest; alpha *= 2) {       // as far as it goes down
    if (!take(state, step, alpha, Pace::downhill, next)) break;
    const double e = energy_.last_terms().total();
    if (!(e < lowest)) break;
    best = next, lowest = e, left = true;
  }
  for (double alpha = 0.5e-3; !left && alpha > 1e-9; alpha /= 4)   // or as far as it needs
    if (alpha <= farthest && take(state, step, alpha, Pace::downhill, next) && energy_.last_terms().total() < lowest)
      best = next, left = true;
  state = best;
  return left;
}

Report Newton::correct(State& state, const Eigen::MatrixXd& held, const State* from) {
  const Stopwatch watch;
  Report report;
  const int factorizations_before = factors_.factorizations();
  const double factor_seconds_before = factors_.seconds();
  const auto end = [&](Status status, std::string why) {
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds(), report.factor_seconds = factors_.seconds() - factor_seconds_before;
    return finish(state, report, {status, std::move(why)});
  };
  State previous;
  std::vector<double> sizes;                                    // |p| of every iteration
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, from);
    ++report.evaluations;
    record(report, moved, 0);
    const bool settled = report.residual <= options_.tolerance;
    if (!settled || !std::isfinite(report.energy))
      if (const auto halt = must_halt(state, report)) return end(halt->status, halt->why);
    factors_.factorize_holding(held);
    if (settled) {
      polish(state, report, [&](const Vector& g) { return factors_.solve_holding(g); });
      return end(Status::converged, fmt::format("the residual is below {:g}", options_.tolerance));
    }
    const Vector p = -factors_.solve_holding(energy_.gradient());
    sizes.push_back(p.norm());
    const std::size_t k = sizes.size() - 1;
    if (!p.allFinite() || (k >= 4 && !(sizes[k] < sizes[k - 2])))
      return end(Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", report.residual));
    const double turn = part_within_turn(state, p), alpha = turn * free_part(state, p, turn);
    moved = alpha * infinity_norm(p);
    previous = state;
    from = &previous;
    energy_.kinematics().retract(state, p, alpha);
  }
}

}  // namespace elamin
