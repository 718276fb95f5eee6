#pragma once
// From a branch point onto the branches that cross there.
#include "path/arc.hpp"
#include "path/event.hpp"

#include <vector>

namespace elamin {

/// The first equilibrium on a side branch, and the direction that leads away from the branch point.
struct SideBranch {
  Equilibrium first;
  Direction direction;
  Vector leaving;                      // unit vector of the displacement from the branch point, within the critical modes
};

/// First equilibria of the branches that leave a branch point along its critical modes, both ways of each.
/// A simple point: along ±φ. A multiple one: Lyapunov–Schmidt; on circles in the plane of each two modes, the directions
/// where the force along the circle vanishes; of directions that are images of each other by symmetry (the same load
/// factor and the same energy at the same distance) one, both ways; where the force vanishes all around, the first mode.
/// They lie as far as turns a bond by about 0.02 rad, nearer if Newton does not find them there. What could not be found
/// is left out.  Source: Keller 1977; Allgower & Georg 1990, ch. 8.
std::vector<SideBranch> side_branches(Newton& newton, const Event& branch_point, const Metric& metric);

}  // namespace elamin
