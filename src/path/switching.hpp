#pragma once
// From a branch point onto the branches that cross there.
#include "path/arc.hpp"
#include "path/event.hpp"

#include <vector>

namespace elamin {

/// A branch that leaves a branch point: its direction there, and how long a first step may be.
struct SideBranch {
  Equilibrium at;                      // the branch point; what is neutral on the side branch is among its zero modes
  Direction direction;
  Vector leaving;                      // unit vector of the direction within the critical modes (dofs)
  double step = 0;                     // in the metric
};

/// The branches that leave a branch point along its critical modes, both ways of each.
/// A simple point: along ±φ. A multiple one: Lyapunov–Schmidt; on circles in the plane of each two modes, the directions
/// where the force along the circle vanishes; of directions that are images of each other by symmetry (the same load
/// factor and the same energy at the same distance) one, both ways. Where the second mode costs nothing on the branch along the first
/// one, the branch is one of a family at the same load factors: it is neutral, and the first one stands for all.
/// The amplitude a of the first step keeps λ(a) − λ(0) within `load_step`, and the rotation of a bond within `rotation` (rad). What could
/// not be found is left out.  Source: Keller 1977; Allgower & Georg 1990, ch. 8.
std::vector<SideBranch> side_branches(Newton& newton, const Event& branch_point, const Metric& metric, double load_step, double rotation);

}  // namespace elamin
