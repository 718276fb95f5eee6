#include "study/trace.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/equilibrium.hpp"
#include "study/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr double largest_imposed = 0.3;        // distortion of a bond that supports may impose in one go

Outcome trace_energy(const Problem& problem, Newton& newton, const Sink& sink) {
  const State state = starting_state(problem, newton.energy());
  newton.energy().evaluate(state);
  Equilibrium e = assess(newton, state, {});
  if (interrupted()) return tell_interrupted(newton, state, sink);
  e.point.report.residual = newton.energy().relative(newton.energy().gradient());
  e.point.report.status = Status::converged;
  if (e.point.report.residual > problem.solver.tolerance) e.point.stability.stable = false;                // it is no equilibrium
  const bool finite = std::isfinite(e.point.energy.total());
  if (!finite) e.point.report.status = Status::not_converged;
  sink.point(e.point, true);
  if (finite) return {Status::converged, "energies and forces of the state in the file"};
  return {Status::not_converged, not_finite(newton.energy(), state)};
}

// Whether supports and walls can go from one state to the other at once: no bond turns or stretches far, and nothing passes
// through anything.
bool reachable(const Energy& energy, const State& from, const State& to) {
  const Field moved = displacement(from, to);
  for (const Bond& b : energy.model().bonds) {
    const auto [i, j] = b.particles;
    const double length = (from.at(j) - from.at(i)).hi.norm();
    if (length > 0 && (moved.col(j) - moved.col(i)).norm() > largest_imposed * length) return false;
  }
  return energy.collision_free_step(from, to) >= 1;
}

// The minimum at the load factor, from a state where nothing is imposed yet: supports and walls are brought there in steps
// as large as `reachable` allows, a minimum after each.
Report bring(Newton& newton, State& state, double load_factor, const Corrector& minimum) {
  constexpr double smallest = 1.0 / (1 << 20);
  const Kinematics& kinematics = newton.energy().kinematics();
  const double from = state.load_factor;
  Report report;
  for (double done = 0, step = 1;;) {                              // parts of the way
    State next = state;
    const double to = std::min(1.0, done + step);
    kinematics.prescribe(next, to == 1 ? load_factor : from + to * (load_factor - from));
    if (!reachable(newton.energy(), state, next)) {
      step /= 2;
      if (step >= smallest) continue;
      newton.energy().evaluate(state, false);
      report.status = Status::not_converged, report.residual = newton.energy().relative(newton.energy().gradient());
      report.why = fmt::format("supports or walls could not go on from load factor {:.10g}: something would pass through "
                               "something else or be torn", state.load_factor);
      return report;
    }
    report = minimum(next);
    state = next, done = to, step *= 2;
    if (done == 1 || !report.converged()) return report;
  }
}

// One state: the minimum at full load. A state that is taken up again stands near it already.
Outcome trace_equilibrium(const Problem& problem, Newton& newton, const Sink& sink) {
  const Model& model = newton.energy().model();
  State state = model.restart ? starting_state(problem, newton.energy()) : model.start;
  if (!model.restart) newton.energy().kinematics().prescribe(state, state.load_factor);     // what is constant, in full
  const Corrector minimum = minimiser_of(problem, newton);
  Report report = model.restart ? minimum(state) : bring(newton, state, starting_load_factor(problem), minimum);
  newton.energy().evaluate(state, false);
  if (report.converged() && !std::isfinite(newton.energy().last_terms().total()))
    report.status = Status::not_converged, report.why = not_finite(newton.energy(), state);
  if (report.converged())
    if (const std::string what = gone_through(newton.energy(), state); !what.empty()) report.status = Status::not_converged, report.why = what;
  if (report.status == Status::not_converged && interrupted()) report.status = Status::interrupted, report.why = "interrupted";
  if (report.status == Status::not_converged)
    if (const std::string what = obstacle(newton.energy(), state); report.why.find(what) == std::string::npos) report.why += "; " + what;
  Equilibrium e = assess(newton, state, report);
  if (gave_up || interrupted()) report.status = Status::interrupted, report.why = "interrupted", e = assess(newton, state, report);
  sink.point(e.point, true);
  return {report.status, report.why};
}

}  // namespace

double starting_load_factor(const Problem& problem) {
  return problem.path.start_lambda.value_or(problem.follows_path() ? problem.path.from : 1.0);
}

std::string not_finite(const Energy& energy, const State& state) {
  const std::string what = obstacle(energy, state);
  return "the energy is not finite here: " + (what.empty() ? "particles coincide, or do not fit into a curved wall" : what);
}

State starting_state(const Problem& problem, const Energy& energy) {
  State state = energy.model().restart.value_or(energy.model().start);
  energy.kinematics().prescribe(state, starting_load_factor(problem));
  return state;
}

Outcome tell_interrupted(Newton& newton, const State& state, const Sink& sink) {
  Report report;
  report.status = Status::interrupted, report.why = "interrupted";
  sink.point(assess(newton, state, report).point, true);
  return {report.status, report.why};
}

Outcome trace(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, const Sink& sink, Archive* stopped) {
  gave_up = false;
  if (problem.follows_path()) return trace_path(problem, model, stored, sink, stopped);
  if (problem.in_time()) return trace_dynamics(problem, model, sink, stopped);
  Energy energy(model);
  Stage whole;
  sink.stage(whole, energy);
  Newton newton(energy, solver_options(problem));
  if (problem.study == StudyType::modes) return trace_modes(problem, newton, sink);
  return problem.study == StudyType::energy ? trace_energy(problem, newton, sink) : trace_equilibrium(problem, newton, sink);
}

}  // namespace elamin
