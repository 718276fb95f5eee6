#include "core/dense.hpp"
#include "solve/newton.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "solve/limits.hpp"
#include "solve/steady_bodies.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace elamin {

namespace {

// Whether a force acts along a negative mode that is no stiffer by far than the lowest: Newton's step leaves the saddle along it.
bool pushed(const EigenPairs& lowest, const Vector& g) {
  for (Eigen::Index k = 0; k < lowest.values.size() && lowest.values[k] <= limits::alike * lowest.values[0]; ++k)
    if (std::abs(lowest.vectors.col(k).dot(g)) > limits::no_push * g.norm()) return true;
  return false;
}

}  // namespace

// The part of p that one step may take: rotations within bounds, nothing longer than the whole …
double Newton::part_within_rotation(const State& state, const Vector& p, double load_change) const {
  constexpr double tiny = std::numeric_limits<double>::min();
  return std::min({1.0, limits::largest_rotation / std::max(distortion(energy_, state, p, load_change), tiny),
                   extent_ / std::max(infinity_norm(p), tiny)});
}

// … and nothing through anything: the part of part · p.
double Newton::free_part(const State& state, const Vector& p, double part) const {
  State to = state;
  energy_.kinematics().retract(to, p, part);
  return energy_.collision_free_step(state, to);
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

// Where rounding hides the energy: whether the residual falls, or the step that the same factor gives from where part α has led is shorter, by α/2 at least of what the
// model says; unlike the residual that does not change with the units of forces, nor does it ask for more of what is stiff. Source: Deuflhard
// 2011, Newton Methods for Nonlinear Problems, §3.3 (natural monotonicity).
bool Newton::comes_nearer(const Step& step, double alpha) {
  const Vector& g = energy_.gradient();
  if (infinity_norm(g) < 0.9 * infinity_norm(step.g)) return true;
  const std::optional<Vector> convex = step.resolved ? factors_.solve_convex(g) : std::nullopt;
  return (convex ? *convex : factors_.cholesky().solve(g)).norm() <= (1 - alpha / 2) * step.p.norm();
}

// A long step is good if the energy falls but for what was not predicted of it. Where rounding hides that, and the curvature along the step is
// negative, a slope that is negative at its end, too, tells it.
bool Newton::take_long(const State& from, const Step& step, double alpha, State& to) {
  energy_.evaluate(to, false);
  const double change = energy_.last_terms().total() - step.energy;
  if (!std::isfinite(change)) return false;
  if (step.hidden(alpha)) return (step.curvature < 0 && energy_.gradient().dot(step.p) < 0) || comes_nearer(step, alpha);
  const double wanted = limits::armijo * step.predicted(alpha);
  return change <= wanted || change - energy_.residual_energy(to, from) <= wanted;
}

// Downhill the energy itself must fall; simplified Newton corrections across the step bend it back that stretched the structure, until
// hardly anything of that is left, which would stiffen the next Hessian. The first correction takes the stretch away, and also bends the structure
// under the force of that stretch; the second takes this bending back, and may be as long. So each is compared with the last but one, or,
// where something may touch and longer steps could go past it, with the last. Leaves the best state in `to`, and the energy evaluated there.
bool Newton::take_downhill(const State& from, const Step& step, double alpha, State& to) {
  double last = infinity, before_last = last;
  const double enough = limits::relaxed * alpha * step.p.norm();
  const bool touching = may_touch(energy_.model());
  std::optional<State> fallen;
  for (int k = 0;; ++k) {
    energy_.evaluate(to, false);
    const double change = energy_.last_terms().total() - step.energy;
    const bool falls = std::isfinite(change) && (!step.hidden(alpha) ? change <= limits::armijo * step.predicted(alpha)
                                                 : step.leaves      ? energy_.gradient().dot(step.p) < 0
                                                                    : comes_nearer(step, alpha));
    if (falls && (k == 0 || energy_.collision_free_step(from, to) == 1)) fallen = to;
    Vector correction;
    bool on = std::isfinite(change) && k < limits::most_corrections && !(fallen && step.leaves);
    if (on) {
      correction = -factors_.cholesky().solve(Vector(energy_.gradient() - step.g - alpha * step.hp));
      correction -= step.p * (step.p.dot(correction) / step.p.squaredNorm());
      on = correction.norm() <= limits::contraction * (touching ? last : before_last) && !(fallen && correction.norm() <= enough);
    }
    if (!on) break;
    before_last = std::exchange(last, correction.norm());
    energy_.kinematics().retract(to, correction);
  }
  if (!fallen) return false;
  to = *fallen;
  energy_.evaluate(to, false);
  return true;
}

// Leaves a factor of H + μP in place of H, P what compression takes from H, and remembers μ ≤ 1: twice the least of a list that makes that
// positive definite, so that motions along which the structure buckles double at each step. Shifts H + τI hold soft motions and stiff ones
// alike. What is left of them with all of P, for loose parts, is returned. None: it takes more than that, and H is as before.
std::optional<double> Newton::without_compression(const State& state, const Vector& g, Descent& descent) {
  const auto evaluate = [&](double part) {
    energy_.evaluate(state, true, {.from = descent.from(), .convex = part});
    steady_bodies(energy_, g);
  };
  const auto definite = [&](double part) { return evaluate(part), factors_.try_cholesky(0); };
  for (double part = std::max(descent.pressed / 4, limits::least_pressed); part < 1 && !interrupted(); part *= 4)
    if (definite(part)) {
      descent.pressed = part;
      if (definite(std::min(2 * part, 1.0)) || definite(part)) return 0;
    }
  descent.pressed = 1;
  if (definite(1)) return 0;
  const double shift = std::max(factors_.zero_level(), limits::least_shift * infinity_norm(g) / extent_);
  if (factors_.try_cholesky(shift)) return shift;
  evaluate(0);
  return {};
}

// Leaves a factor of the Hessian, or of a positive definite one near to it, and returns the shift τ that it has. Where compression does not tell
// how to make H definite, it is H + τI, τ of the size of the lowest eigenvalue; a state that has no slope along that mode is moved off the
// saddle instead (`left`), but not twice in a row: Newton's steps must take the rest of the way down. None: there is no factor.
std::optional<double> Newton::make_convex(State& state, const Vector& g, Descent& descent, bool settled, bool& left) {
  const bool stays = std::exchange(descent.left, false) || descent.pace == Pace::stationary;
  left = descent.eased = false;
  const double sigma = factors_.zero_level();
  if (!settled && factors_.try_cholesky(0)) return 0;       // a settled state has a negative eigenvalue, whatever a rounded factor tells
  if (!settled && factors_.try_cholesky(sigma)) return factors_.make_positive_from(limits::hold_zero_modes * sigma);   // rounding would fill the step with a zero mode
  if (!settled && !std::exchange(descent.refused, false))
    if (const std::optional<double> shift = without_compression(state, g, descent)) return descent.eased = true, shift;
  const std::optional<double> positive = factors_.make_positive_from(std::max(descent.shift / 4, 16 * sigma), 32);
  if (!positive) return {};
  const EigenPairs lowest = settled ? factors_.lowest(1, *positive) : factors_.lowest(limits::modes_looked_at, *positive, 0.1);
  if (settled || (!stays && !pushed(lowest, g))) {
    left = leave_saddle(state, lowest.vectors.col(0));
    if (left) return std::abs(lowest.values[0]);
    energy_.evaluate(state);
    steady_bodies(energy_, g);
  }
  return factors_.make_positive_from(lowest.values[0] < 0 ? std::min(-2 * lowest.values[0], *positive) : *positive);
}

// The Newton step, with a shift τ so large that no dof moves by more than about `step_bound`: along a direction that has a force
// but hardly a stiffness, as of a grain that must slide, the step would be of no use however it is cut.
std::optional<Newton::Step> Newton::step_within(double step_bound, const Vector& g, double& shift) {
  Step step = newton_step(g, shift);
  while (infinity_norm(step.p) > 2 * step_bound) {
    const std::optional<double> stiffer = factors_.make_positive_from(std::max(4 * shift, infinity_norm(g) / (4 * step_bound)), 4);
    if (!stiffer) return {};
    step = newton_step(g, shift = *stiffer);
  }
  return step;
}

// Where a step goes along motions that are softer than the shift that makes a factor, it is by far too short: slender structures bend that
// softly. Then it is taken with what forms tell of their stiffness (see inertia.cpp). Where steps are many already, it may be that a factor without
// shift is one by rounding alone; but where something may touch, long steps along what floats lead past it. False: there is no factor any more.
bool Newton::resolve_softest(const Vector& g, const Descent& descent, Step& step) {
  const double sigma = factors_.zero_level(), shift = descent.shift;
  const bool slow = descent.report.iterations >= limits::slow && !may_touch(energy_.model());
  if (energy_.model().bonds.empty() || shift > limits::hold_zero_modes * sigma || (shift == 0 && !slow)) return true;
  const Vector soft = slow ? factors_.cholesky().solve(step.p) : step.p;         // of inverse iteration: the softest is most of it
  if (energy_.quadratic_form(soft) > std::max(shift, limits::doubtful * sigma) * soft.squaredNorm()) return true;
  factors_.inertia();
  std::optional<Vector> p = factors_.solve_convex(-g);
  if (!p || !p->allFinite() || infinity_norm(*p) > 2 * descent.step_bound)      // what falls freely goes by the shift
    return factors_.make_positive_from(shift).has_value();
  step.resolved = true, step.p = std::move(*p), step.hp = energy_.multiply(step.p);
  step.slope = g.dot(step.p), step.curvature = step.p.dot(step.hp);
  return true;
}

bool Newton::leave_saddle(State& state, const Vector& direction) {
  energy_.evaluate(state);
  if (!factors_.make_positive_from(-2 * energy_.quadratic_form(direction) / direction.squaredNorm())) return false;
  Step step;
  Vector loose = Vector::Zero(direction.size());                // grains that slide rotate hardly any bond: their way counts, in diameters
  for (const int d : energy_.unbonded_dofs()) loose[d] = direction[d];
  const double change = std::max(distortion(energy_, state, direction), movement(energy_, loose)), unit = change > 0 ? change : movement(energy_, direction);
  if (!(unit > 0)) return false;
  step.p = direction / unit;
  step.g = energy_.gradient();
  if (step.g.dot(step.p) > 0 && step.g.norm() > 0 && residual() > options_.tolerance) step.p = -step.p;
  step.hp = energy_.multiply(step.p);
  step.energy = energy_.last_terms().total(), step.curvature = energy_.quadratic_form(step.p);
  step.leaves = true;
  if (!(step.curvature < 0)) return false;
  State best = state, next;
  double lowest = step.energy;
  bool left = false;
  const auto goes_down = [&](double alpha) {
    if (!take(state, step, alpha, Pace::downhill, next)) return false;
    const double e = energy_.last_terms().total();
    if (!(e < lowest || step.hidden(alpha))) return false;
    best = next, lowest = std::min(e, lowest);
    return left = true;
  };
  for (int side = 0; side < 2 && !left; ++side) {               // forces that are left below the tolerance may point away from one of them
    if (side == 1) step.p = -step.p, step.hp = -step.hp;
    step.slope = std::min(0.0, step.g.dot(step.p));
    const double farthest = free_part(state, step.p, limits::largest_rotation) * limits::largest_rotation;
    for (double alpha = 1e-3; alpha <= farthest && !interrupted() && goes_down(alpha); alpha *= 2) {}     // as far as it goes down …
    for (double alpha = 0.5e-3; !left && alpha > 1e-9; alpha /= 4)                                        // … or as far as it needs
      if (alpha <= farthest) goes_down(alpha);
  }
  state = best;
  return left;
}

}  // namespace elamin
