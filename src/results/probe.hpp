#pragma once
// Some observables at any state.
#include "energy/energy.hpp"
#include "results/observables.hpp"

namespace elamin {

/// All closed contacts of a state, what an event has located as touching, and open ones as far as the observed gaps need.
std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables);

/// Evaluates on an energy of its own, so that nobody's evaluation is disturbed.
class Probe {
 public:
  /// These of the [[observe]]s of a problem, ascending, with all that they are made of. The model must outlive this. Throws as Observables
  /// does.
  Probe(const Problem& problem, const Model& model, const std::vector<std::size_t>& numbers);
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  /// One number for each.
  std::vector<double> operator()(const State& state);

  Energy& energy() { return energy_; }
  const std::vector<ObserveTable>& observed() const { return problem_.observe; }

 private:
  Problem problem_;                    // with these observables alone
  Energy energy_;
  Observables observables_;
};

}  // namespace elamin
