#pragma once
// What [[observe]] asks for: numbers taken from the particles of a group, or from a wall.
#include "energy/touch.hpp"
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
///   velocity      of a motion; where nothing moves, of the model (a state has none)
///   gap           the smallest distance of its surface from any particle (in the group or not) or wall that it has a
///                 contact law with; negative: overlap. Pairs left out as glued, and E_eff = 0, do not count; nothing where
///                 there is none
///   contacts      how many contacts of it are closed (gap < 0 by more than rounding); a pair within the group counts for both, a block's wall
///                 once for each of its faces
/// Component x, y, z or norm = √(x² + y² + z²), over the particles of the group: mean, sum, min, max.
/// sum and norm: the norm of the summed vector (of a reaction: of the resultant). mean, min, max and norm: of the norms
/// of the particles.
///
/// Quantities of a wall, which a group may be the name of:
///   reaction      the force of the wall on each particle that touches it; sum: on the structure
///   contacts      how many closed contacts each of these has with it; sum: all of them
///   gap           of every particle of the wall's group to the wall
/// reaction and contacts are reduced over the particles that touch the wall: mean, min and max are nothing where none
/// does, sums are 0.
class Observables {
 public:
  /// Both must outlive this. Throws InputError for a group that is not there or has no particle, and for a quantity
  /// that a wall has not.
  Observables(const Problem& problem, const Model& model);

  std::vector<std::string> names() const;

  /// Whether these contacts, all those with gaps up to some reach, tell every gap that is asked for: a minimum needs one
  /// of its particles in the list, the other reductions all of them. True where no gap is observed.
  bool sufficient(const std::vector<Touch>& touches) const;

  /// One number for every [[observe]], in their order, not finite where there is nothing; forces: −∂U/∂x of all particles
  /// with the loads, 3 × particles; touches: all closed contacts, and open ones where a gap is observed.
  /// velocity: of all particles, 3 × particles; null: the model's.
  std::vector<double> evaluate(const State& state, const Field& forces, const std::vector<Touch>& touches,
                               const Field* velocity = nullptr) const;

 private:
  struct Subject {
    const std::vector<int>* particles = nullptr;      // of the group, or of the wall's group
    int wall = -1;                                    // of Model::walls; −1: it is a group
  };
  std::vector<Vec3> of_group(const ObserveTable& o, const Subject& subject, const State& state, const Field& forces,
                             const std::vector<Touch>& touches, const Field& velocity) const;
  std::vector<Vec3> of_wall(const ObserveTable& o, const Subject& subject, const std::vector<Touch>& touches) const;
  std::vector<double> gaps(int wall, const std::vector<Touch>& touches) const;

  const Problem& problem_;
  const Model& model_;
  std::vector<Subject> subjects_;                     // of every [[observe]]
  Eigen::Matrix<bool, 3, Eigen::Dynamic> held_;       // by supports: 3 × particles
};

}  // namespace elamin
