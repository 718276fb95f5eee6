#pragma once
// From the lists of a model to the element groups of its energy.
#include "energy/law_group.hpp"
#include "energy/neighbours.hpp"
#include "laws/hertz_contact.hpp"

#include <memory>

namespace elamin {

/// One kind a type; where there are changes, one more for every type and choice of changes that act on it.
std::unique_ptr<ElementGroup> bond_group(const Model& model);
std::unique_ptr<ElementGroup> angle_group(const Model& model);
/// Edges of the loops under pressure, one kind a loop.
std::unique_ptr<ElementGroup> pressure_group(const Model& model);
/// Hertz contacts of the candidate pairs, one law a pair: E_eff of its table, radii of its particles.
std::unique_ptr<ElementGroup> contact_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> cohesion_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> wall_group(const Model& model);
/// What hard contacts add to the Lagrangian.
std::unique_ptr<ElementGroup> hard_pair_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> hard_wall_group(const Model& model);

/// The law between two particles that have a Hertz table.
HertzContact hertz_contact(const Model& model, int table, int i, int j);

}  // namespace elamin
