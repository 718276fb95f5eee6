#pragma once
// A motion in time, from its starting state to its last step.
#include "study/trace.hpp"

namespace elamin {

/// Velocity Verlet over the steps of [dynamics]; yields a moment at every step that has a row or a frame. Ends where a
/// position is not finite any more, with the last moment that was.
Outcome trace_dynamics(const Problem& problem, const Model& model, const Sink& sink, Archive* stopped = nullptr);

}  // namespace elamin
