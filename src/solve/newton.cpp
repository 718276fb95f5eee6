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

double infinity_norm(const Vector& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

// A step p = −M⁻¹g + (a direction of negative curvature), M = H + τI, with what the model predicts along it.
struct Newton::Step {
  Vector p, g, hp;             // hp = H p
  double energy, slope, curvature, energy_rounding;
  Pace pace = Pace::long_steps;
  bool keep_direction = false; // corrections stay orthogonal to p: along a soft p they would overshoot
};

Newton::Newton(Energy& energy, NewtonOptions options) : energy_(energy), options_(options), factors_(energy) {}

double Newton::residual() const { return energy_.relative(energy_.gradient()); }

void Newton::record(Report& report, double step, double shift) const {
  report.energy = energy_.last_terms().total();
  report.residual = residual();
  report.history.push_back({report.energy, report.residual, step, shift});
}

bool Newton::attempt(const State& from, const Step& step, double alpha, State& to) {
  to = from;
  energy_.kinematics().retract(to, step.p, alpha);
  const double predicted = alpha * step.slope + alpha * alpha / 2 * step.curvature;
  const bool hidden = std::abs(predicted) <= step.energy_rounding;
  const double before = infinity_norm(step.g);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= most_corrections; ++k) {
    energy_.evaluate(to, false);
    const double change = energy_.last_terms().total() - step.energy;
    if (!std::isfinite(change)) return false;
    if (hidden ? infinity_norm(energy_.gradient()) < 0.9 * before : change <= armijo * predicted) return true;
    if (step.pace == Pace::long_steps) return !hidden && change - energy_.unpredicted(to, from) <= armijo * predicted;
    Vector correction = -factors_.cholesky().solve(Vector(energy_.gradient() - step.g - alpha * step.hp));
    if (step.keep_direction) correction -= step.p * (step.p.dot(correction) / step.p.squaredNorm());
    const double size = correction.norm();
    if (!(size <= contraction * last) || k == most_corrections) return false;
    last = size;
    energy_.kinematics().retract(to, correction);
  }
  return false;
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

Report Newton::minimise(State& state, Pace pace) {
  const Stopwatch watch;
  Report report;
  const int factorizations_before = factors_.factorizations();
  double guess = 0;                                             // for the next shift
  int unseen = 0;                                               // steps whose change of energy rounding hid
  const auto finish = [&](Status status, std::string why) {
    energy_.evaluate(state);
    report.energy = energy_.last_terms().total(), report.residual = residual();
    report.status = status, report.why = std::move(why);
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds();
    return report;
  };
  State previous;
  bool linearised = false;                                      // previous holds where the last step came from
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, linearised ? &previous : nullptr);
    ++report.evaluations;
    if (!std::isfinite(energy_.last_terms().total()))
      return finish(Status::not_converged, "the energy is not finite here: particles of an angle coincide");
    record(report, moved, guess);
    const bool settled = report.residual <= options_.tolerance;
    if (settled) {
      if (linearised) energy_.evaluate(state);
      const Inertia inertia = factors_.inertia();
      report.negative = inertia.negative;
      if (inertia.negative == 0) {
        // With a zero mode the exact factor would fill the steps with its rounding.
        factors_.try_cholesky(inertia.zero > 0 ? 100 * factors_.zero_level() : 0.0);
        polish(state, report, [&](const Vector& g) { return factors_.cholesky().solve(g); });
        return finish(Status::converged, fmt::format("the residual is below {:g} and the Hessian has no negative eigenvalue", options_.tolerance));
      }
    }
    if (interrupted()) return finish(Status::interrupted, "interrupted");
    if (report.iterations == options_.max_iterations)
      return finish(Status::not_converged, fmt::format("{} iterations were not enough; the residual is {:.2g}", options_.max_iterations, report.residual));

    const Vector g = energy_.gradient();
    guess = factors_.make_positive(guess / 4);
    const double sigma = factors_.zero_level();
    if (guess > sigma) {                                        // indefinite: |H|'s size along the lowest mode
      const EigenPairs lowest = factors_.lowest(1, guess);
      if (settled || std::abs(lowest.vectors.col(0).dot(g)) <= 1e-6 * g.norm()) {
        if (leave_saddle(state, lowest.vectors.col(0))) { guess = std::abs(lowest.values[0]), linearised = false; continue; }
        if (settled) return finish(Status::not_converged, "a saddle could not be left along its negative curvature");
        energy_.evaluate(state);
      }
      guess = -2 * lowest.values[0];
      while (!factors_.try_cholesky(guess)) guess *= 2;
    } else if (guess > 0) {                                     // a zero mode: rounding alone would fill the step with it
      guess = 100 * sigma;
      factors_.try_cholesky(guess);
    }
    Step step;
    step.g = g, step.pace = pace;
    step.p = -factors_.cholesky().solve(g);
    step.hp = -g - guess * step.p;
    step.energy = energy_.last_terms().total();
    step.slope = g.dot(step.p), step.curvature = step.p.dot(step.hp);
    const EnergyTerms& terms = energy_.last_terms();
    step.energy_rounding = 16 * epsilon * (std::abs(terms.bond) + std::abs(terms.angle) + std::abs(terms.external));
    const double distortion = energy_.distortion(state, step.p);
    double alpha = std::min(1.0, largest_turn / std::max(distortion, 1e-300));
    State next;
    // Where rounding hides the energy's change and the model is convex, Newton's step itself is the best there is.
    const bool hidden = std::abs(step.slope) <= step.energy_rounding && guess <= 100 * sigma && ++unseen <= most_unseen;
    if (hidden) {
      next = state;
      energy_.kinematics().retract(next, step.p, alpha);
    }
    while (!hidden && !attempt(state, step, alpha, next)) {
      ++report.evaluations;
      alpha /= 2;
      if (alpha < 1e-12) {
        return finish(Status::not_converged, fmt::format("no step lowers the {}; the residual stays at {:.2g}",
            std::abs(step.slope) <= step.energy_rounding ? "residual below rounding" : "energy", report.residual));
      }
    }
    moved = alpha * infinity_norm(step.p);
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
  const double unit = energy_.distortion(state, direction);
  if (!(unit > 0)) return false;
  step.p = direction / unit;
  step.g = energy_.gradient();
  if (step.g.dot(step.p) > 0 && step.g.norm() > 0 && residual() > options_.tolerance) step.p = -step.p;
  step.hp = energy_.multiply(step.p);
  step.energy = energy_.last_terms().total();
  step.slope = std::min(0.0, step.g.dot(step.p)), step.curvature = energy_.quadratic_form(step.p);
  step.energy_rounding = 0;
  step.keep_direction = true, step.pace = Pace::downhill;
  if (!(step.curvature < 0)) return false;
  State best = state, next;
  double lowest = step.energy;
  bool left = false;
  for (double alpha = 1e-3; alpha <= largest_turn; alpha *= 2) {   // as far as it goes down
    if (!attempt(state, step, alpha, next)) break;
    const double e = energy_.last_terms().total();
    if (!(e < lowest)) break;
    best = next, lowest = e, left = true;
  }
  for (double alpha = 0.5e-3; !left && alpha > 1e-9; alpha /= 4)   // or as far as it needs
    if (attempt(state, step, alpha, next) && energy_.last_terms().total() < lowest) best = next, left = true;
  state = best;
  return left;
}

Report Newton::correct(State& state, const Eigen::MatrixXd& held, const State* from) {
  const Stopwatch watch;
  Report report;
  const int factorizations_before = factors_.factorizations();
  const auto project = [&](Vector v) {
    if (held.cols() > 0) v -= held * (held.transpose() * v);
    return v;
  };
  bool definite = true;
  const auto solve = [&](const Vector& g) {
    const Vector b = project(g);
    return project(definite ? factors_.cholesky().solve(b) : factors_.pivoted().solve(b));
  };
  const auto finish = [&](Status status, std::string why) {
    energy_.evaluate(state);
    report.energy = energy_.last_terms().total(), report.residual = residual();
    report.status = status, report.why = std::move(why);
    report.factorizations = factors_.factorizations() - factorizations_before;
    report.seconds = watch.seconds();
    return report;
  };
  State previous;
  std::vector<double> sizes;                                    // |p| of every iteration
  for (double moved = 0; ; ++report.iterations) {
    energy_.evaluate(state, true, from);
    ++report.evaluations;
    if (!std::isfinite(energy_.last_terms().total()))
      return finish(Status::not_converged, "the energy is not finite here: particles of an angle coincide");
    record(report, moved, 0);
    const double shift = held.cols() > 0 ? 100 * factors_.zero_level() : 0.0;    // as above: held modes may be zero modes
    definite = factors_.try_cholesky(shift);
    if (!definite && !factors_.try_pivoted(shift)) factors_.try_pivoted(shift + factors_.zero_level());
    if (report.residual <= options_.tolerance) {
      polish(state, report, solve);
      return finish(Status::converged, fmt::format("the residual is below {:g}", options_.tolerance));
    }
    if (interrupted()) return finish(Status::interrupted, "interrupted");
    if (report.iterations == options_.max_iterations)
      return finish(Status::not_converged, fmt::format("{} iterations were not enough; the residual is {:.2g}", options_.max_iterations, report.residual));
    const Vector p = -solve(energy_.gradient());
    sizes.push_back(p.norm());
    const std::size_t k = sizes.size() - 1;
    if (!p.allFinite() || (k >= 4 && !(sizes[k] < sizes[k - 2])))
      return finish(Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", report.residual));
    const double alpha = std::min(1.0, largest_turn / std::max(energy_.distortion(state, p), 1e-300));
    moved = alpha * infinity_norm(p);
    previous = state;
    from = &previous;
    energy_.kinematics().retract(state, p, alpha);
  }
}

}  // namespace elamin
