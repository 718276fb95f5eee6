#pragma once
// Who is held, loaded, heavy and dragged.
#include "problem/build_groups.hpp"

namespace elamin {

/// Adds the supports to the model. A mistake: two that prescribe one coordinate differently; one that leaves the plane.
/// Returns whether all of them could be built.
bool add_supports(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds loads, gravity, viscosity, pressures and changes. A mistake: a force out of the plane; a radial one on the axis;
/// gravity on particles without density; a change of nothing, or to nothing.
void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Every particle must have a mass, or that is told; of dynamics.
void need_masses(const Problem& problem, const Model& model, Mistakes& mistakes);

}  // namespace elamin
