#include "results/probe.hpp"

#include "model/entities.hpp"

#include <limits>

namespace elamin {
namespace {

Problem only(const Problem& problem, const std::vector<std::size_t>& numbers) {
  Problem some;
  some.file = problem.file;
  for (const std::size_t k : numbers) some.observe.push_back(problem.observe[k]);
  return some;
}

}  // namespace

std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables) {
  constexpr double at_touch = 1e-9;                             // of the largest size: what an event has located
  const double largest = largest_size(energy.model());
  std::vector<Touch> touches = energy.touches(state, at_touch * largest);
  const double extent = sides_of(state).maxCoeff();
  for (double reach = largest / 4; !observables.sufficient(touches); reach *= 4) {
    const bool all = !(reach > 0 && reach < extent);
    touches = energy.touches(state, all ? std::numeric_limits<double>::infinity() : reach);
    if (all) break;
  }
  return touches;
}

Probe::Probe(const Problem& problem, const Model& model, const std::vector<std::size_t>& numbers)
    : problem_(only(problem, numbers)), energy_(model), observables_(problem_, model) {}

std::vector<double> Probe::operator()(const State& state) {
  return observables_.evaluate(state, energy_.forces(state), observed_touches(energy_, state, observables_));
}

}  // namespace elamin
