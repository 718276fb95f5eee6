#pragma once
// Observables at states: what they need besides the state itself.
#include "energy/energy.hpp"
#include "path/options.hpp"
#include "results/observables.hpp"

namespace elamin {

/// All closed contacts of a state, what an event has located as touching, and open ones as far as the observed gaps need.
std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables);

/// The [[event]]s of a problem as functions of a state. They evaluate on an energy of their own, so that nobody's
/// evaluation is disturbed; problem and model must outlive them.
std::vector<Watch> watches(const Problem& problem, const Model& model);

}  // namespace elamin
