#pragma once
// A rounded body at a wall.
#include "laws/region.hpp"
#include "laws/rounded/kernel.hpp"
#include "laws/rounded/pair_view.hpp"

namespace elamin {

/// What a wall does to one vertex of a body.
struct RoundedWallTouch {
  int vertex = 0;
  double gap = 0;                              // from the ball about the vertex to the wall; negative: overlap [length]
  Vec3 normal = Vec3::Zero();                  // unit, from the wall into its free side
  Vec3 point = Vec3::Zero();                   // of the wall
  double force = 0;                            // along the normal; negative: attraction
  int face = 0;                                // of the region, see WallGap
};

/// A rounded body and a wall: E = Σ U(s − ρ) over the vertices, s the signed distance of a vertex from the wall, U the
/// kernel (k_na = 0: k_n (s − ρ)²/2 for s < ρ). Exact for a plane, of either side, and inside of a block, cylinder,
/// sphere or cone: there the vertices are the points of the core nearest to the wall. From outside a region edges and
/// faces would count: not here. At a plane s goes on below it; a vertex that has left another region feels nothing.
/// C¹ as the kernel is. Source: LAMMPS, fix wall/body/polyhedron, as a true potential; the distances: wall_gap.hpp.
struct RoundedWall {
  Region region;
  bool inside = true;                          // a plane: the side that its normal points into
  RoundedKernel kernel;

  /// Whether this is the wall of a body: a plane, or the inside of a region.
  bool exact() const { return region.shape == Shape::plane || inside; }

  double value(const RoundedBody& body) const;
  /// By (x, θ).
  Local<2> derivatives(const RoundedBody& body) const;
  /// Every vertex and face with gap ≤ r_c, appended.
  void touches(const RoundedBody& body, std::vector<RoundedWallTouch>& out) const;
};

}  // namespace elamin
