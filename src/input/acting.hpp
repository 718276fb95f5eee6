#pragma once
// Who is held, loaded, heavy and dragged.
#include "input/groups.hpp"

namespace elamin {

/// Adds the supports to the model. A mistake: two that prescribe one coordinate differently; one that leaves the plane;
/// one turn held alone.
/// Returns whether all of them could be built.
bool add_supports(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds loads, gravity, viscosity, pressures and changes. A mistake: a force out of the plane; a radial one on the axis;
/// gravity on particles without density or bodies without mass; a change of nothing, or to nothing.
void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Every particle and body must have a mass, or that is told; of dynamics.
void need_masses(const Problem& problem, const Model& model, Mistakes& mistakes);

/// A vector that has a component along the normal of the plane is a mistake.
void stay_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v,
                   Mistakes& mistakes);

}  // namespace elamin
