#pragma once
// What [[observe]] asks for: numbers taken from the particles of a group.
#include "model/model.hpp"
#include "problem/problem.hpp"

#include <string>
#include <vector>

namespace elamin {

/// Quantities of a particle [length, force, length/time]:
///   position      x
///   displacement  x − x_start, from positions and tails: it keeps its digits however small it is
///   reaction      −f at the coordinates that a support holds, 0 elsewhere: the force of the support on the structure,
///                 f = −∂U/∂x with all loads; what a plane holds is not counted
///   velocity      of the model (a state has none)
/// Component x, y, z or norm = √(x² + y² + z²), over the particles of the group: mean, sum, min, max.
/// sum and norm: the norm of the summed vector (of a reaction: of the resultant). mean, min, max and norm: of the norms
/// of the particles.
class Observables {
 public:
  /// Both must outlive this. Throws InputError for a group that is not there or has no particle.
  Observables(const Problem& problem, const Model& model);

  std::vector<std::string> names() const;

  /// One number for every [[observe]], in their order; forces: −∂U/∂x of all particles with the loads, 3 × particles.
  std::vector<double> evaluate(const State& state, const Field& forces) const;

 private:
  Vec3 of_particle(Quantity quantity, int particle, const State& state, const Field& forces) const;

  const Problem& problem_;
  const Model& model_;
  std::vector<const Group*> groups_;                  // of every [[observe]]
  Eigen::Matrix<bool, 3, Eigen::Dynamic> held_;       // by supports: 3 × particles
};

}  // namespace elamin
