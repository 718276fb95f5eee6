#pragma once
// The form of a rigid body with rounded corners: a convex core and the radius of the ball that rounds it.
#include "core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace elamin {

/// What a core is made of. One vertex: a sphere; two: a rod; four and more: a convex polyhedron.
struct CoreMesh {
  std::vector<Vec3> vertices;                  // in the frame of the body
  std::vector<std::array<int, 2>> edges;       // pairs of vertices; empty: those of the faces (of a rod: the one)
  std::vector<std::vector<int>> faces;         // three or more vertices each, counter-clockwise seen from outside
};

/// The Minkowski sum of a convex core and a ball. Everything is in the frame of the body. Made by `rounded_shape`.
struct RoundedShape {
  struct Edge {
    int from = 0, to = 0;
    int left = -1, right = -1;                 // faces that run along from → to and to → from; −1: a rod
    bool flat = false;                         // between coplanar faces: only a line on a face, no feature of the core
  };
  struct Face {
    Vec3 normal;                               // unit, outward
    double offset = 0;                         // the plane is n·x = offset [length]
    std::vector<int> corners;
    std::vector<Vec3> inward;                  // of the side from corner k to the next: n × side, points into the face
  };

  std::vector<Vec3> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  double radius = 0;                           // ρ of the ball [length]
  double extent = 0;                           // largest |vertex|: the core fits a sphere of this radius [length]
  double shortest_edge = 0;                    // 0 for a sphere [length]

  /// The bounding sphere of the body about the origin of its frame [length].
  double bounding_radius() const { return extent + radius; }
};

/// Everything that is wrong with a core and its radius, one sentence each; empty: nothing. Asked for: finite numbers;
/// radius > 0; 1, 2, 4 or more vertices, all different; faces of three or more different vertices, planar, convex,
/// closed (every side met once in each direction), outward; every vertex a corner of the hull; edges, if given, those
/// of the faces. Within 3e-6 of the size of the core faces are planar,
/// so that corners written with six digits will do; other tolerances are 1e-8. The sentences count vertices, edges and faces from
/// `first`.
std::vector<std::string> mistakes(const CoreMesh& core, double radius, int first = 0);

/// The body of a core without mistakes. Edges that are not given come face after face, side after side.
RoundedShape rounded_shape(const CoreMesh& core, double radius);

/// The cores of the common bodies, each centred at the origin. Lengths are those of the core, without rounding.
CoreMesh point_core();
/// From −length/2 to length/2 along x.
CoreMesh rod_core(double length);
/// Regular, two of its edges parallel to x and y.
CoreMesh tetrahedron_core(double edge);
/// Sides along x, y, z.
CoreMesh box_core(const Vec3& sides);
inline CoreMesh cube_core(double edge) { return box_core(Vec3::Constant(edge)); }

/// Mass, centre and inertia for unit density.
struct MassProperties {
  double volume = 0;
  Vec3 center = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();                 // about the centre: ∫ (|y|² I − y yᵀ) dV, y = x − center
};

/// Of the rounded solid, exactly: core, a slab on every face, a sector of a cylinder on every edge, of a ball on every
/// vertex. (LAMMPS reads these numbers from its data file.)
MassProperties mass_properties(const RoundedShape& shape);

/// The same core with the origin moved to `center`.
CoreMesh moved_origin(CoreMesh core, const Vec3& center);

}  // namespace elamin
