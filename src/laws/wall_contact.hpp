#pragma once
// A sphere at a rigid wall: Hertz's law on the gap to the surface of a region.
#include "laws/law.hpp"
#include "laws/region.hpp"

namespace elamin {

/// What one face of a wall does to one sphere.
struct WallTouch {
  double gap = 0;                              // distance of the surfaces; negative: overlap
  Vec3 normal = Vec3::Zero();                  // unit, from the wall into the sphere: the direction of the force on it
  Vec3 point = Vec3::Zero();                   // of the wall's surface, nearest to the sphere
  double effective_radius = 0;
  double force = 0;                            // ≥ 0
  int face = 0;                                // see WallGap
};

/// One face that a sphere overlaps, in plain arithmetic.
struct WallPress {
  double overlap = 0;                          // δ > 0
  Vec3 normal = Vec3::Zero();                  // unit, the direction of the force on the sphere
  double effective_radius = 0;
};

/// Hertz's contact of a sphere of radius r with a rigid wall, the sum over the faces that it overlaps of
///   U = 8/15 E √R_eff δ^{5/2} = 2/5 k δ^{5/2},  δ = r − d(x) > 0,  k = 4/3 E √R_eff
/// d the distance of the centre from the face, n = ∇d, E the effective modulus [force/length²]:
///   ∇U = −k δ^{3/2} n + U/(2R_eff) ∇R_eff
///   ∇²U = 3/2 k δ^{1/2} n nᵀ − k δ^{3/2} ∇²d − k δ^{3/2}/(2R_eff) (n ∇R_effᵀ + ∇R_eff nᵀ)
///         + U/(2R_eff) ∇²R_eff − U/(4R_eff²) ∇R_eff ∇R_effᵀ
/// The same holds with the wall's radius as a fourth coordinate, which gives ∂(∇U)/∂R. Which faces act, d, R_eff and
/// their derivatives: wall_gap.hpp. R_eff depends on x only at a `curved` cone; LAMMPS leaves that out of its force.
/// C² only at first touch, as Hertz's law. U jumps where the centre leaves the wall's side; on the axis or in the centre
/// of a wall that is smaller than the sphere; and, if `curved`, outside on the line over a rim where R_eff jumps. Outside
/// a region with open faces ∇U jumps where the nearest point does.
/// U = +inf, without derivatives, where a `curved` wall has no room for the sphere (R_eff infinite): r ≥ R in a sphere,
/// r ≥ 2R in a cylinder, r ≥ 2R_c at a cone.
/// Source: Guerra 2021, eq. (5) (R_eff = r); LAMMPS, fix wall/gran/region (curved).
struct WallContact {
  Region region;                               // where the wall is now
  bool inside = true;
  double effective_modulus = 0;                // E_eff
  bool curved = false;

  static constexpr int most_faces = 6;

  /// Energy of a sphere of radius r at x [energy]; zero where its centre has left the wall's side.
  double value(const ExactVector& x, double r) const;
  /// With gradient and Hessian with respect to x.
  Local<1> derivatives(const ExactVector& x, double r) const;
  /// ∂(∇U)/∂R [force/length]: how the gradient changes when the radius of the wall grows (of a cone: both, see
  /// Region::moved); zero for planes and blocks.
  Vec3 radius_rate(const ExactVector& x, double r) const;
  /// Every face nearer than `cutoff` (distance of the surfaces ≤ cutoff; force zero where they do not overlap), at most
  /// most_faces; returns their number.
  int touches(const ExactVector& x, double r, double cutoff, std::array<WallTouch, most_faces>& out) const;
  /// The faces that the sphere overlaps, most_faces at most, in plain doubles: planes, blocks from inside, spheres and the
  /// sides of endless cylinders at once, all others by way of touches(). Each pushes with k δ^{3/2} along its normal.
  /// The region must be rounded(): its displacement is not looked at.
  int presses(const Vec3& x, double r, std::array<WallPress, most_faces>& out) const;
  /// What ∇R_eff adds to that: the force on the sphere less what the faces push; zero but at a curved cone.
  Vec3 curving_force(const Vec3& x, double r) const;
};

}  // namespace elamin
