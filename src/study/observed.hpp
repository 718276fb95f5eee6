#pragma once
// Observables whose values are looked for.
#include "path/options.hpp"
#include "results/probe.hpp"

namespace elamin {

/// The [[event]]s of a problem as functions of a state; problem and model must outlive them.
std::vector<UserEvent> user_events(const Problem& problem, const Model& model);

}  // namespace elamin
