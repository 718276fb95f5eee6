#pragma once
// A structure that is not quite as it is meant.
#include "model/model.hpp"

namespace elamin {

/// Moves every particle by its column of `by` (3 × particles) and notes the largest of these in Model::imperfection.
/// stress_free: rest lengths and rest angles change with the shape, by as much as the lengths and angles do, so that what was at rest
/// is; else they stay as they were.
void displace(Model& model, const Field& by, bool stress_free);

/// Whether a displacement turns an angle that is straight at rest of a row (not of a sheet): then, stress-free in space, it may turn
/// about the row without resistance, as an angle at rest has no direction.
bool bends_a_row(const Model& model, const Field& by);

}  // namespace elamin
