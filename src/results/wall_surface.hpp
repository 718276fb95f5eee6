#pragma once
// Walls as surfaces, for pictures.
#include "results/body_picture.hpp"

namespace elamin {

/// The closed faces of a wall. A plane is a square around the foot of the box's centre, as wide as the box's diagonal; a cylinder without end
/// goes as far as the box. What is round has 48 sides.
Surface surface_of(const Region& wall, const Eigen::AlignedBox3d& box);

}  // namespace elamin
