#pragma once
// The triangles of a sheet's lattice, as a surface.
#include "model/model.hpp"

#include <array>
#include <vector>

namespace elamin {

/// Every three particles of a structure that are bonded to each other, counterclockwise as built about `normal`; of a tube about the
/// direction away from the axis along `normal` through `center`.
std::vector<std::array<int, 3>> lattice_triangles(const Model& model, const Structure& structure, const Vec3& center, const Vec3& normal, bool tube);

/// The edges that belong to one triangle alone, in its direction.
std::vector<std::array<int, 2>> rim_edges(const std::vector<std::array<int, 3>>& triangles);

}  // namespace elamin
