#include "path/jump.hpp"

#include "core/factor_counts.hpp"
#include "path/limits.hpp"

#include <fmt/format.h>

#include <tuple>
#include <utility>

namespace elamin {

using namespace limits;

// Downhill the state stays in its valley; where that is long and narrow, long steps go on from there, and on, unless few are allowed.
Report go_down(Newton& newton, State& state) {
  const CountFor snap(FactorsFor::snaps);
  Report report = newton.minimise(state, Pace::downhill, jump::most_downhill);
  for (int k = 0; k < jump::most_descents && report.status == Status::not_converged && (k == 0 || report.iterations > jump::most_downhill); ++k)
    report = newton.minimise(state);
  return report;
}

Equilibrium jump_from(Newton& newton, const Event& event, double past, std::string& what) {
  Energy& energy = newton.energy();
  const double at = event.at.point.state.load_factor;
  State state;
  // From a branch point, or a contact behind which a family is not stable, the snap begins at the unstable equilibrium beyond; where there is none so far away,
  // nearer to the event.
  const bool from_saddle = event.kind == EventKind::branch || (event.kind == EventKind::contact && event.modes.cols() > 0);
  for (int k = 0;; ++k, past = at + (past - at) / 4) {
    state = event.at.point.state;
    energy.kinematics().prescribe(state, past);
    if (!from_saddle) break;
    State beyond = state;
    energy.kinematics().retract(beyond, event.at.tangent, past - at);
    // With the critical modes held; where the tangent has them to interpolation only, what is missing comes at the end.
    bool found = newton.correct(beyond, event.modes, &event.at.point.state).converged();
    if (const State held = beyond; !found) {
      found = newton.correct(beyond, {}, &event.at.point.state).converged();
      found = found && energy.kinematics().difference(held, beyond).norm() <= jump::most_freed * std::abs(past - at) * event.at.tangent.norm();
    }
    found = found && energy.collision_free_step(event.at.point.state, beyond) == 1;
    if (found) state = std::move(beyond);
    if (found || k == jump::most_nearer) break;
  }
  const State from = state;
  energy.evaluate(from);
  const double before = energy.last_terms().total();
  Report report;
  for (Eigen::Index j = 0; j == 0 || (from_saddle && j < event.modes.cols()); ++j) {   // of several critical modes rounding has chosen which is the first
    state = from;
    if (from_saddle) std::ignore = newton.leave_saddle(state, event.modes.col(j));     // where not, minimise looks for a way itself
    report = go_down(newton, state);
    if (report.status != Status::not_converged) break;
  }
  what = fmt::format("from energy {:.10g} to {:.10g} at load factor {:.10g}", before, report.energy, past);
  if (report.converged()) return assess(newton, state, report);
  Equilibrium failed;
  failed.point.state = state;
  report.why = fmt::format("no minimum was found after {} at load factor {:.10g}: {}", event.at.point.label, at, report.why);
  failed.point.report = report;
  return failed;
}

}  // namespace elamin
