#pragma once
// Which features of two bodies LAMMPS lets act on each other, and where.
#include "laws/rounded/core_distance.hpp"
#include "laws/rounded/pose.hpp"

#include <functional>

namespace elamin {

constexpr double lammps_epsilon = 1e-3;        // its one tolerance, for lengths, angles and parameters

/// A body with its vertices and normals in world axes, about a chosen origin.
struct LammpsPlaced {
  const RoundedShape* shape;
  Vec3 center;
  std::vector<Vec3> vertices, normals;

  LammpsPlaced(const RoundedBody& body, const Vec3& center);
  bool sphere() const { return vertices.size() == 1; }
};

/// A point of one body (`first_of`: 0 for i, 1 for j) on `first`, the foot on `second` of the other. `distance` is that
/// of the rules, which for parallel edges is not |point − foot|.
struct LammpsHit {
  int first_of;
  Feature first, second;
  Vec3 point, foot;
  double distance;
  bool through = false, parallel = false;
};

/// Calls `hit` with each, in LAMMPS's order: edges of i on faces of j, edges of j on faces of i, edges on edges; a
/// sphere: faces, then edges. Distances beyond the cutoff may be among them: the kernel is 0 there.
void lammps_hits(const LammpsPlaced& i, const LammpsPlaced& j, double cutoff, const std::function<void(const LammpsHit&)>& hit);

}  // namespace elamin
