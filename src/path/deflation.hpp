#pragma once
// Equilibria that no branch at hand leads to.
#include "path/options.hpp"
#include "path/point.hpp"
#include "solve/newton.hpp"

namespace elamin {

/// Up to options.deflate equilibria, other than those given, at the load factors options.deflate_at (none: `to`): Newton's
/// method on the deflated residual
///   M(x) g(x),   M(x) = Π (1 + (ρ/|x − xᵢ|)²),
/// which does not vanish at the equilibria xᵢ known so far, begun at all known states that are brought to the load factor
/// and at these moved along their lowest modes. ρ: the largest distance of the known ones, or a tenth of the extent.
/// They are labelled deflated:1, …  Source: Farrell, Birkisson, Funke 2015, SIAM J. Sci. Comput. 37.
std::vector<PathPoint> deflate(Newton& newton, const std::vector<State>& known, const PathOptions& options,
                               std::vector<std::string>& notes);

}  // namespace elamin
