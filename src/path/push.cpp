#include "path/push.hpp"

#include "core/sparse.hpp"
#include "path/limits.hpp"
#include "solve/cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

using namespace limits;

double driven_way(const Energy& energy, double load_change) {
  const Kinematics& kinematics = energy.kinematics();
  double way = 0;
  for (int s = 0; s < kinematics.sites(); ++s) way = std::max(way, kinematics.drive(s).norm());
  for (const Wall& w : energy.model().walls) way = std::max(way, std::abs(w.scaling.rate) * w.displacement.norm());
  return way * std::abs(load_change);
}

Report push_aside(Newton& newton, const State& from, double way, double others, State& state) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  Report report;
  if (!(way > 0)) return report;
  const double ground = push::borne * newton.tolerance() * std::max(others, energy.force_floor()) / way;
  Cholesky factor;
  int version = -1;
  double least = std::numeric_limits<double>::infinity();
  // Beside other forces the place is as exact as their rounding lets the ground tell.
  const double exact = others > energy.force_floor() ? 16 * epsilon / (push::borne * newton.tolerance()) : push::stands;
  const int patience = push::patience + std::min(push::most_in_row, static_cast<int>(energy.unbonded_dofs().size()));
  for (int since = 0; report.iterations < push::most_iterations + patience && since < patience; ++report.iterations) {
    energy.evaluate(state);
    const Vector moved = kinematics.difference(from, state), force = energy.gradient() + ground * moved;
    const double left = infinity_norm(force);
    const bool done = energy.slack() && left <= push::left * ground * infinity_norm(moved);
    if (energy.slack()) since = 0, least = std::numeric_limits<double>::infinity();
    else since = left < least / 2 ? 0 : since + 1, least = std::min(least, left);
    // The ground holds them; parts that are glued, beside whose stiffness it is nothing, what is as little as rounding of their rows.
    const auto hold = [&] {
      SparseMatrix h = energy.hessian();
      for (const int d : energy.null_dofs()) h.valuePtr()[h.outerIndexPtr()[d]] = 0;
      Vector rows = Vector::Zero(energy.dofs());
      add_absolute_row_sums(h, rows);
      for (int d = 0; d < energy.dofs(); ++d) h.valuePtr()[h.outerIndexPtr()[d]] += std::max(ground, 16 * epsilon * rows[d]);
      if (version != energy.pattern_version()) factor.analyze(h), version = energy.pattern_version();
      ++report.factorizations;
      return factor.factorize(h, 0);
    };
    if (!hold()) {                                              // an overlap pushes sideways: without what that takes
      if (!(others > 0)) return report;
      energy.evaluate(state, true, {.convex = 1});
      if (!hold()) return report;
    }
    const Vector step = -factor.solve(force);
    if (!step.allFinite()) return report;
    // Where rounding of what bodies do to each other is more than the ground bears, it moves nothing.
    const bool stands = (others > 0 || energy.slack()) && energy.relative(energy.gradient()) <= newton.tolerance() &&
                        infinity_norm(step) <= exact * infinity_norm(moved);
    if (done || stands) {
      report.status = Status::converged, report.why = "what floats is pushed";
      break;
    }
    // A whole step from where nothing overlaps: it leads into an overlap, which shrinks to a third a step. Else one that does not raise the energy: the overlap's
    // share of it may be less than its rounding.
    const double here = energy.slack() ? std::numeric_limits<double>::infinity() : energy.last_terms().total() + 16 * epsilon * energy.last_terms().size();
    double part = 1;
    State next;
    do {
      next = state;
      kinematics.retract(next, step, part);
      if (const double free = energy.collision_free_step(state, next); free < 1) {
        next = state;
        kinematics.retract(next, step, part *= push::freely * free);
      }
      part /= 2;
    } while (!(energy.value(next) <= here) && part > push::shortest);
    state = std::move(next);
  }
  report.energy = energy.last_terms().total(), report.residual = energy.relative(energy.gradient());
  return report;
}

}  // namespace elamin
