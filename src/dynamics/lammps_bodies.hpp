#pragma once
// What LAMMPS's rules do to the bodies of a model: for comparison and for dynamics, not a potential.
#include "energy/body_neighbours.hpp"
#include "laws/rounded/lammps_rules.hpp"

namespace elamin {

/// Where bodies and particles are and how they move: `velocity` 3 × particles, `body_velocity` and `angular_momentum` (axes of
/// space, about the positions) 3 × bodies; each may be empty: at rest.
struct BodyMovement {
  Field velocity, body_velocity, angular_momentum;
};

/// The forces of the pairs whose table has the formulation `lammps` and of walls of that kind, with their damping.
struct LammpsBodyForces {
  double energy = 0;                           // as LAMMPS reports it: RoundedKernel::reported, no energy of walls
  std::vector<Wrench> on;                      // bodies; torques about the positions
  Field on_particles;                          // 3 × particles
  int pairs = 0, walls = 0;                    // that follow these rules: near pairs of entities, walls
  // Of the pairs, indices of entities (see BodyRules): an edge of one goes through a face of the other; more touching contacts than
  // LAMMPS has room for; forces that are no gradient (LammpsPair::conservative).
  std::vector<IndexPair> through, overflow, not_conservative;
};

/// At the state. Pairs i < j in the order of the model, particles before bodies, a particle as a body of one vertex; all near pairs.
/// (LAMMPS takes its neighbour list, of distances within the largest two extents and its skin, without r_c: the skin must be larger.)
LammpsBodyForces lammps_body_forces(const Model& model, const State& state, const BodyMovement& movement = {});

/// Whether any pair of tables or any wall follows these rules.
bool follows_lammps(const Model& model);

/// The rules of a table.
inline LammpsRules lammps_rules(const RoundedPair& table) {
  return {table.kernel, table.damping.normal, table.damping.tangential, table.damping.friction, table.unit_area};
}

/// A plane across an axis, or the faces of a block, as pairs of planes at the load factor. A wall of another kind has none.
std::vector<LammpsWall> lammps_walls(const Wall& wall, double load_factor);

}  // namespace elamin
