#pragma once
// The distance of a sphere from every face of a wall that it may touch, with derivatives.
#include "laws/region.hpp"

namespace elamin {

/// A function f(x, R) of a point and of the wall's radius (see Region::moved), with its derivatives; the coordinates are
/// x, y, z, R.
struct Varying {
  double value;
  Eigen::Vector4d gradient;
  Eigen::Matrix4d hessian;
};

/// One face against one sphere of radius r.
struct WallGap {
  double overlap;                              // δ = r − d, with all its digits; negative: the distance of the surfaces
  Varying distance;                            // d of the centre from the face; by x its gradient is n, into the sphere
  Varying radius;                              // R_eff; +inf where the wall has no room for the sphere's curvature
  int face = 0;                                // with the centre inside: as Region::open counts them; outside, where one point acts: 0
};

struct WallGaps {
  static constexpr int most = 6;
  int count = 0;
  std::array<WallGap, most> gap;               // only the first `count` are set
  const WallGap* begin() const { return gap.data(); }
  const WallGap* end() const { return gap.data() + count; }
};

/// The faces of the region whose surface is not farther than `cutoff` from that of the sphere at x with radius r.
/// The centre inside: every closed face by itself; outside: the one nearest point of the closed faces. Without open faces
/// nothing where the centre is not on the wall's side; with any open face both sides act.
/// A centre on the surface itself is on the wall's side.
/// On the axis of a cylinder or cone and at the centre of a sphere the curved wall has no direction and does nothing.
///   plane, faces of a block, caps          d = n·(x − p),  ∇²d = 0
///   edges and corners of a block, outside  d = |y|, y the part of x − p across the edge,  ∇²d = (P − n nᵀ)/d, P its projector
///   sphere                                 d = ±(|y| − R),  n = ±y/|y|,  ∇²d = ±(I − n nᵀ)/|y|,  ∂d/∂R = ∓1
///   side of a cylinder or cone             d = n_ρ (ρ − R) + n_z z + const,  ∇²d = n_ρ ∇²ρ,
///                                          ∇²ρ = (I − e_z e_zᵀ − e_ρ e_ρᵀ)/ρ
///   rims                                   d = √(a² + b²), a = ρ − R, b = z − z_rim,  ∇²d = (a/d) ∇²ρ + τ τᵀ/d,
///                                          τ = (a ∇b − b ∇a)/d
/// and by R as by −ρ. (LAMMPS's cylinder with an open side does nothing at the rims of its caps; here they act.)
/// R_eff [length]: r at flat walls and where not `curved`; else, with the wall's radius of curvature m,
///   sphere                  m = R:   r m/(m − r) inside, r m/(m + r) outside
///   cylinder, side and rim  m = 2R:  r m/(m − r) inside, r m/(m + r) outside; outside with any open face r
///   cone, side and rim      m = 2R_c, R_c the cone's radius at the nearest point: r m/(m − r) inside and outside
/// as LAMMPS has it; at a cone R_eff depends on x.
WallGaps wall_gaps(const Region& region, bool inside, bool curved, const ExactVector& x, double r, double cutoff);

}  // namespace elamin
