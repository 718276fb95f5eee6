#include "solve/newton.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"

#include <limits>

namespace elamin {

namespace {

double infinity_norm(const Vector& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

// The part of p that one step may take: turns within reach, nothing longer than the whole …
double Newton::part_within_turn(const State& state, const Vector& p, double load_change) const {
  constexpr double tiny = std::numeric_limits<double>::min();
  return std::min({1.0, limits::largest_turn / std::max(distortion(energy_, state, p, load_change), tiny),
                   extent_ / std::max(infinity_norm(p), tiny)});
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
  const double wanted = limits::armijo * step.predicted(alpha);
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
                                          : change <= limits::armijo * step.predicted(alpha);
    if (falls) return k == 0 || energy_.passage(from, to) == 1;
    Vector correction = -factors_.cholesky().solve(Vector(energy_.gradient() - step.g - alpha * step.hp));
    if (step.keep_direction) correction -= step.p * (step.p.dot(correction) / step.p.squaredNorm());
    const double size = correction.norm();
    if (!(size <= limits::contraction * last) || k == limits::most_corrections) return false;
    last = size;
    energy_.kinematics().retract(to, correction);
  }
}

// Leaves a factor of H + τI, positive definite, and returns τ. Where H is indefinite τ is of the size of its lowest
// eigenvalue; a state that has no slope along that mode is moved off the saddle instead (`left`). None: there is no factor.
std::optional<double> Newton::make_convex(State& state, const Vector& g, double guess, bool settled, bool& left) {
  left = false;
  const std::optional<double> positive = factors_.make_positive(guess / 4);
  if (!positive) return {};
  double shift = *positive;
  const double sigma = factors_.zero_level();
  if (shift > sigma) {
    const EigenPairs lowest = settled ? factors_.lowest(1, shift) : factors_.lowest(1, shift, 0.1);
    if (settled || std::abs(lowest.vectors.col(0).dot(g)) <= 1e-6 * g.norm()) {
      left = leave_saddle(state, lowest.vectors.col(0));
      if (left) return std::abs(lowest.values[0]);
      energy_.evaluate(state);
    }
    const double convex = shift;                                // with which there was a factor
    return factors_.make_positive_from(lowest.values[0] < 0 ? std::min(-2 * lowest.values[0], convex) : convex);
  }
  return shift > 0 ? factors_.make_positive_from(limits::hold_zero_modes * sigma) : shift;   // a zero mode: rounding alone would fill the step with it
}

// The Newton step, with a shift τ so large that no dof moves by more than about `reach`: along a direction that has a force
// but hardly a stiffness, as of a grain that must slide, the step would be of no use however it is cut.
std::optional<Newton::Step> Newton::step_within(double reach, const Vector& g, double& shift) {
  Step step = newton_step(g, shift);
  while (infinity_norm(step.p) > 2 * reach) {
    const std::optional<double> stiffer = factors_.make_positive_from(std::max(4 * shift, infinity_norm(g) / (4 * reach)), 4);
    if (!stiffer) return {};
    step = newton_step(g, shift = *stiffer);
  }
  return step;
}

bool Newton::leave_saddle(State& state, const Vector& direction) {
  energy_.evaluate(state);
  if (!factors_.make_positive_from(-2 * energy_.quadratic_form(direction) / direction.squaredNorm())) return false;
  Step step;
  const double turn = distortion(energy_, state, direction), unit = turn > 0 ? turn : movement(energy_, direction);
  if (!(unit > 0)) return false;
  step.p = direction / unit;
  step.g = energy_.gradient();
  if (step.g.dot(step.p) > 0 && step.g.norm() > 0 && residual() > options_.tolerance) step.p = -step.p;
  step.hp = energy_.multiply(step.p);
  step.energy = energy_.last_terms().total();
  step.slope = std::min(0.0, step.g.dot(step.p)), step.curvature = energy_.quadratic_form(step.p);
  step.keep_direction = true;
  if (!(step.curvature < 0)) return false;
  const double farthest = free_part(state, step.p, limits::largest_turn) * limits::largest_turn;
  State best = state, next;
  double lowest = step.energy;
  bool left = false;
  for (double alpha = 1e-3; alpha <= farthest && !interrupted(); alpha *= 2) {       // as far as it goes down
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

}  // namespace elamin
