#pragma once
#include "laws/rounded/kernel.hpp"
#include "laws/rounded/pair_view.hpp"

#include <optional>

namespace elamin {

/// Where two cores are nearest: a vertex of one at any feature of the other, or two edges. Signed: cores that overlap
/// have minus the smallest translation that separates them.
struct ClosestFeatures {
  double distance = 0;                         // of the cores
  bool edges = false;
  bool first = true;                           // the vertex is A's
  int vertex = 0;
  CoreDistance at;                             // of that vertex, in the frame of the other body
  int edge_a = 0, edge_b = 0;
  LinePair lines;                              // in the frame of B
};

/// Of the cores seen in `view`; nothing if they are farther apart than `range`. Disjoint cores: the least over vertex
/// against core and over edge against edge. Otherwise the axis of largest separation among the normals of all faces and
/// the cross products of edges, which are the normals of the faces of the Minkowski difference.
std::optional<ClosestFeatures> closest_features(const PairView& view, double range);

/// Two rounded bodies, one contact at the closest points of the cores: E = U(dist − ρ_A − ρ_B), the exact separation of
/// the rounded surfaces. C¹ in translations while cores do not overlap; in rotations the gradient jumps where closest
/// points are not unique (parallel edges or faces): for bodies that rest on faces take RoundedMulti. Symmetric in the
/// bodies.
struct RoundedClosest {
  RoundedKernel kernel;

  double value(const RoundedBody& a, const RoundedBody& b) const;
  PairLocal derivatives(const RoundedBody& a, const RoundedBody& b) const;
  /// The wrenches on A and B, minus the gradient; with `contacts` the contact is appended as below.
  std::array<Wrench, 2> forces(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>* contacts = nullptr) const;
  /// The contact, if its gap ≤ r_c, appended.
  void contacts(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out) const;
};

/// The signed distance of the cores of two bodies [length]; its sum with −ρ_A − ρ_B is the gap of the surfaces. NaN where a
/// position is.
double core_separation(const RoundedBody& a, const RoundedBody& b);

/// Whether the cores overlap: then no potential of rounded bodies means much.
bool cores_overlap(const RoundedBody& a, const RoundedBody& b);

}  // namespace elamin
