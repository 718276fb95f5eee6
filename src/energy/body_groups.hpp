#pragma once
// Rigid bodies in the energy: pairs, walls, loads. Rotations are in units of length (see Kinematics).
#include "energy/body_neighbours.hpp"
#include "energy/kinematics.hpp"
#include "energy/law_group.hpp"
#include "laws/rounded/wall.hpp"

#include <memory>

namespace elamin {

/// Two bodies, four sites; or a body and a particle, three: place and rotation of the body, the particle. Pairs whose table follows
/// LAMMPS's rules are not in it: those have no potential.
std::unique_ptr<ElementGroup> body_pair_group(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours);
/// `carried`: of particles that a body carries, or of those that none does.
std::unique_ptr<ElementGroup> body_particle_group(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours,
                                                  bool carried);
/// Bodies at walls, those that follow LAMMPS's rules left out.
std::unique_ptr<ElementGroup> body_wall_group(const Model& model, const Kinematics& kinematics);
/// Forces at points of bodies, weights and loads of glued particles, torques.
std::unique_ptr<ElementGroup> body_load_group(const Model& model, const Kinematics& kinematics);

/// The wall for bodies as it stands at the load factor λ.
RoundedWall rounded_wall_at(const Wall& wall, double load_factor);
/// E of two bodies by the potential of a table.
PairLocal rounded_derivatives(const RoundedPair& table, const RoundedBody& a, const RoundedBody& b);
void rounded_contacts(const RoundedPair& table, const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out);

}  // namespace elamin
