#include "path/start.hpp"

#include "energy/step_limits.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace elamin {

Equilibrium first_equilibrium(Newton& newton, const State& start, double load_factor, WhenUnstable when_unstable, bool stored,
                              const Corrector& descend, std::string& note) {
  State state = start;
  newton.energy().kinematics().prescribe(state, load_factor);
  const State given = state;
  if (stored) {
    newton.energy().evaluate(state);
    Report as_it_is;
    as_it_is.energy = newton.energy().last_terms().total();
    as_it_is.residual = newton.energy().relative(newton.energy().gradient());
    as_it_is.status = Status::converged, as_it_is.why = "the state as it was stored";
    if (as_it_is.residual <= newton.tolerance()) return assess(newton, state, as_it_is);
  }
  newton.energy().evaluate(state);
  const bool falls = !falling(newton.energy()).empty();         // what nothing holds has no branch to be on before it has come to rest
  Report report = falls ? Report{} : newton.correct(state);
  std::optional<Equilibrium> saddle;
  if (report.converged()) {
    Equilibrium e = assess(newton, state, report);
    // Along a motion that costs nothing a correction is the quotient of two roundings.
    if (State still = given; e.zero_modes.cols() > 0 && e.point.stability.negative == 0)
      if (const Report again = newton.correct(still, e.zero_modes); again.converged()) e = assess(newton, still, again);
    if (e.point.stability.negative == 0 || when_unstable != WhenUnstable::jump) return e;
    note = fmt::format("the starting state is unstable ({} negative eigenvalues); it goes down to a minimum", e.point.stability.negative);
    saddle = std::move(e);
  } else {
    state = given;
  }
  report = descend ? descend(state) : newton.minimise(state);
  if (report.converged()) return assess(newton, state, report);
  if (saddle && report.status == Status::not_converged && report.residual <= newton.tolerance()) {
    note = fmt::format("the starting state is unstable ({} negative eigenvalues), but so little that no lower one beside it can be told from it", saddle->point.stability.negative);
    return *saddle;
  }
  Equilibrium failed;
  failed.point.state = state;
  report.why = fmt::format("no equilibrium at the start, load factor {:.10g}: {}", load_factor, report.why);
  failed.point.report = report;
  return failed;
}

}  // namespace elamin
