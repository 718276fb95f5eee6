#pragma once
// From the lists of a model to the element groups of its energy.
#include "energy/body_neighbours.hpp"
#include "energy/kinematics.hpp"
#include "energy/element_group.hpp"
#include "energy/neighbours.hpp"

#include <memory>

namespace elamin {

struct CosineAngle;
struct HarmonicBond;
struct HertzContact;

/// The elements without glued particles, and those with (see CarriedGroup).
struct Parts {
  std::unique_ptr<ElementGroup> free, carried;
};

/// One kind a type; where there are changes, one more for every type and choice of changes that act on it.
Parts bond_group(const Model& model, const Kinematics& kinematics);
Parts angle_group(const Model& model, const Kinematics& kinematics);
/// The law of every bond and of every angle at a load factor, with what the changes make of it.
std::vector<HarmonicBond> bond_laws(const Model& model, double load_factor);
std::vector<CosineAngle> angle_laws(const Model& model, double load_factor);
/// The particles of an angle in the order in which its law sees them: in a plane so that they turn about the axis across it as built.
std::array<int, 3> angle_sites(const Model& model, const Angle& angle);
/// Edges of the loops under pressure, one kind a loop.
std::unique_ptr<ElementGroup> pressure_group(const Model& model);
/// Triangles of the sheets under pressure, one kind a sheet.
std::unique_ptr<ElementGroup> sheet_pressure_group(const Model& model);
/// Hertz contacts of the candidate pairs, one law a pair: E_eff of its table, radii of its particles.
Parts contact_group(const Model& model, const Kinematics& kinematics, const Neighbours& neighbours);
Parts cohesion_group(const Model& model, const Kinematics& kinematics, const Neighbours& neighbours);
Parts wall_group(const Model& model, const Kinematics& kinematics);
/// Of bodies with particles: both parts of body_particle_group.
Parts body_particle_groups(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours);
/// What hard contacts add to the Lagrangian.
std::unique_ptr<ElementGroup> hard_pair_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> hard_wall_group(const Model& model);

/// The law between two particles that have a Hertz table.
HertzContact hertz_contact(const Model& model, int table, int i, int j);

}  // namespace elamin
