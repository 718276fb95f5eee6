#pragma once
// What [[observe]] asks for: numbers taken from the particles and bodies of a group, from what is inside it, from a wall.
#include "dynamics/motion.hpp"
#include "energy/energy.hpp"
#include "energy/touch.hpp"
#include "input/problem.hpp"
#include "model/model.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

class Energy;
class PathRates;
struct Mistake;

/// Quantities of a particle or body [length, rad, force, force·length, length/time, rad/time]; x of a body: its centre of mass
///   position      x
///   displacement  x − x_start, from positions and tails: it keeps its digits however small it is
///   rotation      of a body: the rotation vector from where it was at the start, up to 2π
///   reaction      −f at the coordinates that a support holds, 0 elsewhere: the force of the support on the structure,
///                 f = −∂U/∂x with all loads; what a plane holds is not counted
///   torque        of a body: the same of its turns, the torque of the support about its centre
///   velocity      of a motion; where nothing moves, of the model (a state has none)
///   angular_velocity   of a body, as velocity
///   gap           the smallest distance of its surface from any particle (in the group or not) or wall that it has a
///                 contact law with; negative: overlap. Pairs left out as glued, and E_eff = 0, do not count; nothing where
///                 there is none
///   contacts      how many contacts of it are closed (gap < 0 by more than rounding); a pair within the group counts for both, a block's wall
///                 once for each of its faces; bodies may touch at several places
///   contact_force the sum of the forces of contacts and walls on it; cohesion, damping and friction are not in it
///   energy        its share of the energy of all laws, see Energy::shares; of a group the sum
/// of what is inside a group, see Fields, scalars:
///   tension, strain     of the bonds between two of its particles
///   moment, curvature   of the angles that have one of its particles in the middle
///   N, M                stress resultants at its particles that are of a sheet, 11, 22, 12 and principal: max, min
/// Component x, y, z or norm = √(x² + y² + z²), over the particles and bodies of the group: mean, sum, min, max.
/// sum and norm: the norm of the summed vector (of a reaction: of the resultant). mean, min, max and norm: of the norms
/// of the particles.
///
/// Quantities of a wall, which a group may be the name of:
///   reaction      the force of the wall on each particle or body that it touches or attracts; sum: on the structure
///   contacts      how many closed contacts each of these has with it; sum: all of them
///   gap           of every particle of the wall's group to the wall
/// reaction and contacts are reduced over the particles that touch the wall: mean, min and max are nothing where none
/// does, sums are 0.
///
/// Quantities of the shape of a group, from the places of its particles and bodies (see shape_measures.hpp):
///   distance      of its mean place from that of `to`
///   angle         at `through` from the way to the group to that to `to`, or from the direction `axis` to the way from the group to `to`.
///                 Counted about `about`, or about the normal of the plane: 0 to 2π at `through`, −π to π from `axis`; without either 0 to π
///   slope         the angle from `axis` to the bond of its first or last two particles, in the same way
///   extent        along x, y, z, of the places
///   end_to_end    from its first particle to its last one
///   area          inside of its particles as a closed row, along the normal it has at the start, and positive there
///
/// Quantities of others:
///   difference    the first less the second
///   derivative    by the load factor or by another one along the path of equilibria, see PathRates
class Observables {
 public:
  /// Both must outlive this. Throws InputError for a group that is not there or has nothing in it, for a quantity
  /// that a wall has not, and for one of bodies where there are none.
  Observables(const Problem& problem, const Model& model);
  ~Observables();

  /// Whether these contacts, all those with gaps up to some reach, tell every gap that is asked for: a minimum needs one
  /// of its particles in the list, the other reductions all of them. True where no gap is observed.
  bool sufficient(const std::vector<Touch>& touches) const;

  /// One number for every [[observe]], in their order, not finite where there is nothing; forces: −∂U/∂x of all sites
  /// with the loads, 3 × sites, see Energy::forces; touches: all closed contacts, and open ones where a gap is observed.
  /// moving: its velocities count; null: the model's.
  std::vector<double> evaluate(const State& state, const Field& forces, const std::vector<Touch>& touches,
                               const Motion* moving = nullptr) const;

 private:
  struct Subject {
    std::vector<int> entities = {};                   // of the group, or of the wall's group: see model/entities.hpp
    bool known = false;
    int wall = -1;                                    // of Model::walls; −1: it is a group
    std::vector<int> inside = {};                     // bonds or angles of the group
    std::vector<int> to = {}, through = {};           // of other groups
    std::optional<Vec3> about = {};                   // of an angle; of an area its normal
  };
  struct Seen;                                        // a state with what is computed from it once
  Subject subject_of(const ObserveTable& o, Mistakes& mistakes) const;
  void hold_supports();
  double of_shape(const ObserveTable& o, const Subject& subject, const State& state) const;
  std::vector<Vec3> of_group(const ObserveTable& o, const Subject& subject, Seen& seen) const;
  std::vector<Vec3> of_inside(const ObserveTable& o, const Subject& subject, Seen& seen) const;
  Vec3 of_particle(Quantity q, int particle, const Seen& seen) const;
  Vec3 of_body(Quantity q, int body, const Seen& seen) const;
  std::vector<Vec3> of_wall(const ObserveTable& o, const Subject& subject, const std::vector<Touch>& touches) const;
  std::vector<double> gaps(int wall, const std::vector<Touch>& touches) const;
  double number(const std::string& name, const std::vector<double>& values) const;
  double derivative(const ObserveTable& o, Seen& seen) const;

  const Problem& problem_;
  const Model& model_;
  std::vector<Subject> subjects_;                     // of every [[observe]]
  Eigen::Matrix<bool, 3, Eigen::Dynamic> held_;       // by supports: 3 × sites
  std::unique_ptr<Energy> energy_;                    // where an energy is observed
  std::unique_ptr<PathRates> rates_;                  // where a derivative is
};

// Some observables at any state.

/// All closed contacts of a state, what an event has located as touching, and open ones as far as the observed gaps need.
std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables);

/// Evaluates on an energy of its own, so that nobody's evaluation is disturbed.
class Probe {
 public:
  /// These of the [[observe]]s of a problem, ascending, with all that they are made of. The model must outlive this. Throws as Observables
  /// does.
  Probe(const Problem& problem, const Model& model, const std::vector<std::size_t>& numbers);
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  /// One number for each.
  std::vector<double> operator()(const State& state);

  Energy& energy() { return energy_; }
  const std::vector<ObserveTable>& observed() const { return problem_.observe; }

 private:
  Problem problem_;                    // with these observables alone
  Energy energy_;
  Observables observables_;
};

}  // namespace elamin
