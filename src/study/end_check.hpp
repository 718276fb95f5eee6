#pragma once
// The last point of a run, looked at again by other means than those that found it.
#include "model/model.hpp"
#include "path/point.hpp"
#include "results/summary.hpp"

namespace elamin {

/// Holds what is told of a point against the model alone, with nothing that the run has left in memory:
/// - the residual, evaluated anew: no larger than it is told, or the tolerance;
/// - the energy: that of bonds, angles and contacts as a plain sum over particles and bodies in long double, to 1e-12 of its parts;
/// - where it is called stable: plain energies on both sides along the lowest mode and along three random directions v,
///     (16 D(t) − D(2t))/12 = vᵀHv t² + O(t⁶) ≥ 0 but for rounding,   D(t) = E(x + tv) + E(x − tv) − 2 E(x),
///   or D(t) itself, where a contact closes between t and 2t,
///   at distances t where rounding is far below the curvature that is told; a direction on which it is not so for any t is not counted.
/// Not seen is where t cannot be small enough: a minimum at a corner of the energy (bodies that change the features by which they touch), and with hard
/// contacts, whose minimum is one among the shapes that they allow, only residual and energy are held.
EndCheck check_end(const Model& model, const PathPoint& point, double tolerance);

}  // namespace elamin
