#include "solve/nlopt.hpp"

#include "core/timing.hpp"
#include "model/entities.hpp"
#include "solve/limits.hpp"
#include "solve/nlopt_search.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

namespace {

// Half of the diagonal of what there is: a chain may fold anywhere, a truss snap through.
double half_width(const Model& model, const State& state) {
  return (sides_of(state).norm() + largest_size(model)) / 2;
}

}  // namespace

Report minimise_by_nlopt(Newton& newton, State& state, const NloptOptions& options) {
  const Stopwatch watch;
  Energy& energy = newton.energy();
  Report report;
  const int factorizations_before = newton.factors().factorizations();
  const double factor_seconds_before = newton.factors().seconds();
  report.why = nlopt_refuses(options.algorithm, energy.dofs(), any_hard(energy.model()));
  if (!report.why.empty()) return report;
  if (energy.dofs() == 0) return newton.minimise(state);
  const NloptAlgorithm& algorithm = *nlopt_algorithm_of(options.algorithm);
  NloptSearch search(newton, state, options, report);
  if (algorithm.local()) {
    search.local(algorithm);
  } else {
    const double half = options.bounds.value_or(half_width(energy.model(), state));
    const int most = options.max_evaluations / 4 * 3;
    search.global(algorithm, half, algorithm.random_starts() ? std::min(most, limits::nlopt::most_samples) : most);
    const int looked = report.evaluations;
    search.local(*nlopt_algorithm_of("LD_LBFGS"));
    report.why += fmt::format(", from the lowest of the {} states that {} saw within {:.3g} of the start", looked, algorithm.name, half);
  }
  state = search.state();
  if (options.polish && report.status != Status::interrupted) {
    const Report polished = newton.minimise(state);
    const std::string before = report.why;
    report.status = polished.status, report.negative = polished.negative;
    report.why = fmt::format("{}, after {} iterations of Newton's method; before, {}", polished.why, polished.iterations, before);
    report.iterations += polished.iterations, report.evaluations += polished.evaluations;
    report.history.insert(report.history.end(), polished.history.begin(), polished.history.end());
  }
  energy.evaluate(state);
  report.energy = energy.last_terms().total(), report.residual = energy.relative(energy.gradient());
  report.factorizations = newton.factors().factorizations() - factorizations_before;
  report.seconds = watch.seconds(), report.factor_seconds = newton.factors().seconds() - factor_seconds_before;
  return report;
}

}  // namespace elamin
