#pragma once
// What floats is pushed.
#include "solve/newton.hpp"

namespace elamin {

/// Where the parts go that no force holds while something pushes them: the state nearest to `from` in which nothing overlaps and the rest is in
/// equilibrium, the minimum of U(x) + κ/2 |x − x_from|² with κ so small that it bears less than a residual may leave. Step after step this is Moreau's
/// sweeping process. from: what is prescribed stands at its new place already; way: how far that has come at most [length]; others: the largest force that
/// bonds and loads bear meanwhile, 0: none [force]; state: a guess, then the answer, or where something is caught.
/// Not converged where something is caught, so that forces arise, or where parts are glued that nothing holds.
/// Source: Moreau 1977, J. Differential Equations 26, 347, the catching-up algorithm.
[[nodiscard]] Report push_aside(Newton& newton, const State& from, double way, double others, State& state);

/// How far what is prescribed moves at most, supports and walls, while the load factor changes by so much [length].
double driven_way(const Energy& energy, double load_change);

}  // namespace elamin
