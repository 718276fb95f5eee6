#pragma once
#include "path/equilibrium.hpp"
#include "path/options.hpp"

namespace elamin {

/// The equilibrium that a path begins at, for a state with its prescribed coordinates at the load factor: the stationary
/// point near by; the minimum below if there is none, or if it is unstable and the path is one that jumps (then `note` says so).
/// `descend`: how that minimum is found; none: by Newton's method. `stored`: the state comes from a path; it is kept to the bit where its residual allows. Not converged: there is neither.
Equilibrium first_equilibrium(Newton& newton, const State& start, double load_factor, WhenUnstable when_unstable, bool stored,
                              const Corrector& descend, std::string& note);

}  // namespace elamin
