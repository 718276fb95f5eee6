#include "study/solving.hpp"

#include "dynamics/relax.hpp"

namespace elamin {

namespace {

// Damped dynamics: solver.method = "fire", or a study of dynamics that relaxes.
bool damped(const Problem& problem) { return problem.solver.method == "fire" || (problem.study == StudyType::dynamics && problem.dynamics.relax); }

RelaxOptions relax_options(const Problem& problem) {
  RelaxOptions options{.tolerance = problem.solver.tolerance};
  if (problem.study == StudyType::dynamics) options.max_steps = problem.dynamics.steps;
  else if (problem.solver.max_iterations) options.max_steps = *problem.solver.max_iterations;
  return options;
}

}  // namespace

NewtonOptions solver_options(const Problem& problem) {
  NewtonOptions options{.tolerance = problem.solver.tolerance};
  if (problem.solver.by_newton()) options.max_iterations = problem.solver.max_iterations.value_or(options.max_iterations);
  return options;
}

Method solver_method(const Problem& problem) {
  const SolverTable& s = problem.solver;
  if (s.method == "ipopt")
    return IpoptOptions{.tolerance = s.tolerance, .max_iterations = s.max_iterations.value_or(IpoptOptions{}.max_iterations)};
  if (s.by_nlopt()) {
    NloptOptions options = s.nlopt;
    options.algorithm = s.method.substr(6), options.tolerance = s.tolerance;
    return options;
  }
  return s.method == "auto" ? Method(AutoOptions{}) : Method(solver_options(problem));
}

Corrector minimiser_of(const Problem& problem, Newton& newton) {
  if (damped(problem))
    return [&newton, o = relax_options(problem)](State& state) {
      return stable_end(newton, state, [&](State& s) { return relax(newton.energy(), s, o); });
    };
  return [&newton, method = solver_method(problem)](State& state) { return minimise(newton, state, method); };
}

Corrector corrector_of(const Problem& problem, Newton& newton) {
  if (damped(problem)) return [&newton, o = relax_options(problem)](State& state) { return relax(newton.energy(), state, o); };
  const Method method = solver_method(problem);
  if (const auto* o = std::get_if<IpoptOptions>(&method))
    return [&newton, o = *o](State& state) { return minimise_by_ipopt(newton.energy(), state, o); };
  if (const auto* o = std::get_if<NloptOptions>(&method))
    return [&newton, o = *o](State& state) { return minimise_by_nlopt(newton, state, o); };
  return {};
}

}  // namespace elamin
