#include "solve/method.hpp"

#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "solve/limits.hpp"
#include "solve/settle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace elamin {

namespace {

template <class... F> struct Cases : F... { using F::operator()...; };
template <class... F> Cases(F...) -> Cases<F...>;

void add(Report& total, const Report& part) {
  total.status = part.status, total.why = part.why;
  total.history.insert(total.history.end(), part.history.begin(), part.history.end());
  total.iterations += part.iterations, total.factorizations += part.factorizations, total.evaluations += part.evaluations;
  total.energy = part.energy, total.residual = part.residual, total.negative = part.negative;
}

// Simplified Newton steps with the factor of the inertia, kept while they halve the residual; how many.
int finish(Newton& newton, State& state, Report& report, bool zero_modes) {
  Energy& energy = newton.energy();
  Factors& factors = newton.factors();
  if (!factors.try_cholesky(zero_modes ? 100 * factors.zero_level() : 0.0)) return 0;
  for (int k = 0; k < limits::most_polishing; ++k) {
    if (energy.relative(energy.gradient()) <= 4 * epsilon) return k;
    State next = state;
    energy.kinematics().retract(next, factors.cholesky().solve(energy.gradient()), -1);
    if (energy.collision_free_step(state, next) < 1) return k;
    energy.evaluate(next, false);
    ++report.evaluations;
    if (!(energy.relative(energy.gradient()) <= report.residual / 2)) return k;
    state = next, report.residual = energy.relative(energy.gradient());
  }
  return limits::most_polishing;
}

// Newton's method, on and on as long as loose bodies fall and roll farther.
Report until_bodies_rest(Newton& newton, State& state) {
  const double begin = newton.energy().value(state);
  Report total = newton.minimise(state);
  for (double before = begin; total.status == Status::not_converged && total.iterations < limits::most_settling;) {
    if (!(before - total.energy > limits::still_falls * (begin - total.energy))) break;
    before = total.energy;
    add(total, newton.minimise(state));
  }
  return total;
}

// Newton's method and, where there are loose grains that press on something, settle(): for a packing at once, for fewer where Newton's method stalls.
Report by_what_works(Newton& newton, State& state) {
  const Model& model = newton.energy().model();
  const bool presses = std::any_of(model.contacts.begin(), model.contacts.end(), [](const PairContact& c) { return c.effective_modulus > 0; }) ||
                       std::any_of(model.walls.begin(), model.walls.end(), [](const Wall& w) { return w.effective_modulus > 0; });
  if (!model.bodies.empty() && !newton.energy().unbonded_dofs().empty()) return until_bodies_rest(newton, state);
  const int loose = presses && model.bodies.empty() ? unbonded_grains(newton.energy()) : 0;
  if (loose >= limits::packing) return settle(newton, state, limits::most_settling);
  State settled = state;
  const Report report = newton.minimise(state, Pace::long_steps, loose > 0 ? limits::newton_alone : std::numeric_limits<int>::max());
  if (report.status != Status::not_converged || loose == 0) return report;
  Report other = settle(newton, settled, limits::most_settling);
  if (!other.converged()) return interrupted() ? report : newton.minimise(state);
  state = std::move(settled);
  other.why = fmt::format("Newton's method stalled after {} iterations; {}", report.iterations, other.why);
  return other;
}

}  // namespace

std::string name_of(const Method& method) {
  return std::visit(Cases{[](const NewtonOptions&) { return std::string("newton"); },
                          [](const IpoptOptions&) { return std::string("ipopt"); },
                          [](const NloptOptions& o) { return "nlopt:" + o.algorithm; },
                          [](const AutoOptions&) { return std::string("auto"); }}, method);
}

std::string refusal(const Method& method, const Energy& energy) {
  const bool hard = any_hard(energy.model());
  const std::string newton = hard ? "Newton's method knows no hard contacts; use \"ipopt\", or an elastic contact" : "";
  return std::visit(Cases{[&](const NewtonOptions&) { return newton; }, [&](const AutoOptions&) { return newton; },
                          [](const IpoptOptions&) { return std::string(); },
                          [&](const NloptOptions& o) { return nlopt_refuses(o.algorithm, energy.dofs(), hard); }}, method);
}

Report stable_end(Newton& newton, State& state, const std::function<Report(State&)>& search) {
  const Stopwatch watch;
  Energy& energy = newton.energy();
  Factors& factors = newton.factors();
  Report total;
  double searching = 0, factoring = 0;                          // seconds of factors, in the searches and here
  const auto done = [&] {
    total.seconds = watch.seconds(), total.factor_seconds = searching + factoring;
    return total;
  };
  for (int saddles = 0;; ++saddles) {
    const Report found = search(state);
    add(total, found);
    searching += found.factor_seconds;
    if (!found.converged() || energy.dofs() == 0 || !state.hard.empty()) return done();
    const double seconds_before = factors.seconds();
    const int factorizations_before = factors.factorizations();
    energy.evaluate(state);
    ++total.evaluations;
    const Inertia inertia = factors.inertia();
    total.negative = inertia.negative;
    bool left = true;
    if (inertia.negative == 0) {
      const double before = total.residual;
      const int steps = finish(newton, state, total, inertia.zero > 0);
      energy.evaluate(state);
      total.energy = energy.last_terms().total(), total.residual = energy.relative(energy.gradient());
      total.why += " and the Hessian has no negative eigenvalue";
      if (steps > 0)
        total.why += fmt::format("; {} simplified Newton step{} took the residual from {:.1e} to {:.1e}", steps, steps > 1 ? "s" : "", before, total.residual);
      if (saddles > 0) total.why += fmt::format("; {} saddle{} left", saddles, saddles > 1 ? "s were" : " was");
    } else {
      left = !interrupted() && saddles < limits::most_saddles && newton.leave_saddle(state, factors.lowest(1).vectors.col(0));
    }
    factoring += factors.seconds() - seconds_before, total.factorizations += factors.factorizations() - factorizations_before;
    if (inertia.negative == 0) return done();
    if (left) continue;
    if (!interrupted()) {                                       // forces that are left below the tolerance may bend what hardly has a stiffness
      Newton sharp(energy, {.tolerance = 16 * epsilon});
      add(total, sharp.minimise(state, Pace::long_steps, limits::most_sharpening));
      energy.evaluate(state);
      total.negative = factors.inertia().negative, total.residual = energy.relative(energy.gradient());
      if (total.negative == 0 && total.residual <= newton.tolerance()) {
        total.status = Status::converged;
        total.why = found.why + fmt::format("; Newton's method took it to {:.1e}, where the Hessian has no negative eigenvalue", total.residual);
        return done();
      }
    }
    energy.evaluate(state);
    total.status = interrupted() ? Status::interrupted : Status::not_converged;
    total.why = interrupted() ? "interrupted" : "a saddle could not be left along its negative curvature";
    return done();
  }
}

namespace {

// Ipopt may go back to a saddle whose negative curvature is small. Newton's method does not; it knows no hard contacts, and goes as far as none is on the way.
Report downhill(Newton& newton, State& state) {
  Report report;
  do {
    State next = state;
    report = newton.minimise(next, Pace::downhill, limits::most_downhill);
    if (newton.energy().collision_free_step(state, next) < 1) return {};
    state = next;
  } while (report.status == Status::not_converged && report.iterations == limits::most_downhill);
  return report;
}

}  // namespace

Report minimise(Newton& newton, State& state, const Method& method) {
  if (std::string why = refusal(method, newton.energy()); !why.empty()) {
    Report refused;
    newton.energy().evaluate(state);
    refused.energy = newton.energy().last_terms().total();
    refused.residual = newton.energy().relative(newton.energy().gradient());
    refused.why = std::move(why);
    return refused;
  }
  if (std::holds_alternative<NewtonOptions>(method)) return newton.minimise(state);
  if (std::holds_alternative<AutoOptions>(method)) return by_what_works(newton, state);
  bool left = false;                                            // a saddle
  return stable_end(newton, state, [&](State& s) {
    const auto* ipopt = std::get_if<IpoptOptions>(&method);
    if (!ipopt) return minimise_by_nlopt(newton, s, std::get<NloptOptions>(method));
    if (const Report found = left ? downhill(newton, s) : Report{}; found.converged()) return found;
    left = true;
    return minimise_by_ipopt(newton.energy(), s, *ipopt);
  });
}

}  // namespace elamin
