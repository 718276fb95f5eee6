#pragma once
#include "laws/rounded/kernel.hpp"
#include "laws/rounded/pair_view.hpp"

namespace elamin {

/// Two rounded bodies, a sum over their features (for resting faces: it carries a body at several places). ρ = ρ_A +
/// ρ_B:
///   E = Σ κ(b) U(s − ρ) + Σ w U(d − ρ)
/// first sum: vertices of either body, s the signed distance from the other core, b the nearest point there; the
/// feature that holds b names the contact vertex-face, vertex-edge or vertex-vertex. κ = 1 − Σ (1 − S(|b − c|/h))/2
/// over the corners c of the other core, h = corner · (its shortest edge): two vertices meet from both sides and count
/// once together. A body of one vertex acts through that vertex alone, with κ = 1.
/// second sum: pairs of edges, d the distance of their lines, t_a, t_b the places of the feet, ϑ the angle between
/// them:
///   w = S(t_a/ends) S((1 − t_a)/ends) S(t_b/ends) S((1 − t_b)/ends) S(sin²ϑ/sin²angle)
/// S(x) = 6x⁵ − 15x⁴ + 10x³ within 0..1. An edge on a face meets it at its ends and where it crosses the border.
/// C¹ (kernel coded) and symmetric in the bodies while the cores do not overlap; U″ jumps where the kernel's does and
/// where the nearest feature changes. An overlap of the cores is reported by `cores_overlap`.
/// A particle of radius r is a body of `point_core` with its centre at the origin: it has no torque, its rows θ are zero.
/// Gates are numbers without unit: nothing here is absolute.
/// Source: the five kinds of contact of LAMMPS, pair_style body/rounded/polyhedron, as a true potential.
struct RoundedMulti {
  RoundedKernel kernel;
  double corner = 0.1;                         // ≤ 1/2
  double ends = 0.05;                          // ≤ 1/2
  double sine2 = 0.0075961234938959;           // sin² 5°

  double value(const RoundedBody& a, const RoundedBody& b) const;
  PairLocal derivatives(const RoundedBody& a, const RoundedBody& b) const;
  /// The wrenches on A and B, minus the gradient; with `contacts` those are appended as below.
  std::array<Wrench, 2> forces(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>* contacts = nullptr) const;
  /// Every term with gap ≤ r_c and weight > 0, appended.
  void contacts(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out) const;
};

}  // namespace elamin
