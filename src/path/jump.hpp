#pragma once
#include "path/event.hpp"

#include <string>

namespace elamin {

/// The minimum below a state, which is moved there: the nearest one as far as that is told within some steps.
[[nodiscard]] Report go_down(Newton& newton, State& state);

/// The minimum that the state snaps to where a branch turns unstable or ends: from just past the event, at the load factor
/// `past`, along the critical mode, down. `what` tells what was released. Not converged: no minimum was found.
Equilibrium jump_from(Newton& newton, const Event& event, double past, std::string& what);

}  // namespace elamin
