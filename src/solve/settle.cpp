#include "solve/settle.hpp"

#include "core/dense.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace elamin {

namespace {

Model softened(const Model& model, double part) {
  Model soft = model;
  for (PairContact& c : soft.contacts) c.effective_modulus *= part;
  for (Wall& w : soft.walls) w.effective_modulus *= part;
  return soft;
}

// What drives loose grains, the mean force on one that is not of contact; and the part of their moduli at which grains under those of one layer
// of a heap overlap by the wanted part of their size: F = E √R δ^{3/2}.
struct Drive { double force = 0, part = 1; };

Drive drive_of(const Energy& energy, const State& state) {
  const Model& model = energy.model();
  Model alone = model;
  alone.contacts.clear(), alone.walls.clear();
  Energy outside(alone);
  outside.evaluate(state, false);
  double force = 0, modulus = 0, size = 0;
  for (const int d : energy.unbonded_dofs()) force += std::abs(outside.gradient()[d]), size = std::max(size, model.diameter[energy.kinematics().site_of(d)]);
  for (const PairContact& c : model.contacts) modulus = std::max(modulus, c.effective_modulus);
  for (const Wall& w : model.walls) modulus = std::max(modulus, w.effective_modulus);
  const double grains = std::max(unbonded_grains(energy), 1), layer = force / std::pow(grains, 2.0 / 3);
  const double part = layer / (modulus * size * size) / std::pow(limits::wanted_overlap, 1.5);
  return {force / grains, std::isfinite(part) && part > 0 ? std::min(part, 1.0) : 1.0};
}

// A descent, and the longest step that it may take [length].
class Descend {
 public:
  Descend(Energy& energy, Factors& factors, double farthest, Report& report)
      : energy_(energy), factors_(factors), farthest_(farthest), step_bound_(farthest), report_(report) {}

  // Whether the residual gets below the tolerance, and every force below `force`.
  bool to(State& state, double tolerance, double force, int most) {
    energy_.evaluate(state);
    lately_ = {energy_.last_terms().total()};
    for (int k = 0, refused = 0; k < most && !interrupted(); ++k) {
      const double residual = energy_.relative(energy_.gradient());
      report_.history.push_back({energy_.last_terms().total(), residual, moved_, shift_});
      if (residual <= tolerance && infinity_norm(energy_.gradient()) <= force) return true;
      at_iteration(++report_.iterations, residual);
      if (step(state)) refused = 0;
      else if (++refused > limits::most_refused) return false;
    }
    return false;
  }

 private:
  // The smallest shift, of a short list that begins below the last one, farther where that was the first to be tried, with which H + τI is
  // positive definite and the step within reach.
  bool shifted_step(const Vector& g, Vector& p) {
    const double stiff = infinity_norm(g) / step_bound_, least = limits::least_shift * stiff;
    const double below = shift_ / (at_once_ ? 8 : 2), first = below > least ? below : 0.0;
    for (double shift = first; std::isfinite(shift) && !interrupted(); shift = std::max(4 * shift, least)) {
      if (!factors_.try_cholesky(shift)) continue;
      p = -factors_.cholesky().solve(g);
      if (!p.allFinite() || infinity_norm(p) > 2 * step_bound_) continue;
      shift_ = shift, at_once_ = shift == first;
      return true;
    }
    return false;
  }

  // Takes a step if the energy falls as predicted below the highest of the last few, or, where rounding hides that, the residual; and chooses
  // how long the next one may be. A grain that is met in a step overlaps too deeply at first, and the overlap shrinks to a third a step: an
  // energy that must fall at once forbids that.
  bool step(State& state) {
    const Vector g = energy_.gradient();
    const double before = energy_.last_terms().total(), rounding = 16 * epsilon * energy_.last_terms().size();
    Vector p;
    if (!shifted_step(g, p)) return false;
    const double predicted = g.dot(p) - p.dot(g + shift_ * p) / 2, length = infinity_norm(p);
    State next = state;
    energy_.kinematics().retract(next, p, 1);
    energy_.evaluate(next);
    ++report_.evaluations;
    const double change = energy_.last_terms().total() - before;
    const double above = std::max(0.0, *std::max_element(lately_.begin(), lately_.end()) - before);
    const bool hidden = std::abs(predicted) <= rounding;
    if (hidden ? !(infinity_norm(energy_.gradient()) < 0.9 * infinity_norm(g)) : !(change <= above + limits::armijo * predicted)) {
      step_bound_ = length / 4;
      energy_.evaluate(state);
      return false;
    }
    state = std::move(next), moved_ = length;
    lately_.push_back(energy_.last_terms().total());
    if (lately_.size() > limits::falls_within) lately_.pop_front();
    if (change <= predicted / 2) step_bound_ = std::min(farthest_, std::max(step_bound_, 2 * length));
    else if (change > predicted / 4) step_bound_ = length / 2;
    return true;
  }

  Energy& energy_;
  Factors& factors_;
  const double farthest_;
  double step_bound_, shift_ = 0, moved_ = 0;
  bool at_once_ = false;                         // the last shift was the first that was tried
  std::deque<double> lately_;                    // energies
  Report& report_;
};

}  // namespace

int unbonded_grains(const Energy& energy) {
  int count = 0, last = -1;
  for (const int d : energy.unbonded_dofs()) {
    const int site = energy.kinematics().site_of(d);
    if (site != last && site < energy.model().particles()) ++count, last = site;
  }
  return count;
}

Report settle(Newton& newton, State& state, int most) {
  const Stopwatch watch;
  Energy& energy = newton.energy();
  const Model& model = energy.model();
  Report report;
  double smallest = infinity;
  for (const int d : energy.unbonded_dofs()) smallest = std::min(smallest, model.diameter[energy.kinematics().site_of(d)]);
  const double farthest = limits::settling_step * smallest;
  const Drive drive = drive_of(energy, state);
  const auto descend = [&](Energy& in, Factors& factors, double tolerance, double force) {
    const int before = factors.factorizations();
    const bool there = Descend(in, factors, farthest, report).to(state, tolerance, force, most);
    report.factorizations += factors.factorizations() - before;
    return there;
  };
  bool falls = false;                                           // without end: in stiffer contacts as well
  for (double part = drive.part; part < 1 && !falls && !interrupted(); part *= limits::stiffer) {
    const Model soft = softened(model, part);
    Energy in(soft);
    Factors factors(in);
    // Beside bonds that bear far more than a grain weighs a small residual tells nothing of what still falls.
    const double enough = drive.force > 0 ? limits::softened_tolerance * drive.force : infinity;
    falls = !descend(in, factors, std::max(newton.tolerance(), limits::softened_tolerance), enough) && !falling(in).empty();
  }
  if (!falls) descend(energy, newton.factors(), newton.tolerance(), infinity);
  Report last = newton.minimise(state);
  report.history.insert(report.history.end(), last.history.begin(), last.history.end());
  last.history = std::move(report.history);
  last.iterations += report.iterations, last.evaluations += report.evaluations, last.factorizations += report.factorizations;
  last.seconds = watch.seconds();
  last.why = fmt::format("loose grains settled in {} steps, contacts from {:.1g} of their stiffness on; ", report.iterations, drive.part) + last.why;
  return last;
}

}  // namespace elamin
