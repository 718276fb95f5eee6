#pragma once
// Rounded bodies as surfaces, for pictures.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// A closed surface of flat polygons, counter-clockwise seen from outside.
struct Surface {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> polygons;
};

/// The surface of a rounded body in its frame. All points lie on it: the faces of the core, moved outwards by the radius; `arcs`
/// flat strips around every edge, rings of triangles on every vertex. A sphere and each end of a rod have rings of 4 · arcs points.
Surface surface_of(const RoundedShape& shape, int arcs = 4);

/// All bodies at the state as polydata of VTK's legacy format, ASCII, with the cell data `id` and `type`: ParaView and OVITO
/// open it. Throws OutputError if it cannot be written.
void write_picture(const std::string& file, const Model& model, const State& state, const std::string& title);

// Walls as surfaces, for pictures.

/// The closed faces of a wall. A plane is a square around the foot of the box's centre, as wide as the box's diagonal; a cylinder without end
/// goes as far as the box. What is round has 48 sides.
Surface surface_of(const Region& wall, const Eigen::AlignedBox3d& box);

}  // namespace elamin
