#pragma once
// From the lists of a model to the element groups of its energy.
#include "energy/law_group.hpp"
#include "energy/neighbours.hpp"
#include "laws/hertz_contact.hpp"

#include <memory>

namespace elamin {

std::unique_ptr<ElementGroup> bond_group(const Model& model);
std::unique_ptr<ElementGroup> angle_group(const Model& model);
/// Hertz contacts of the candidate pairs, one law a pair: E_eff of its table, radii of its particles.
std::unique_ptr<ElementGroup> contact_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> cohesion_group(const Model& model, const Neighbours& neighbours);
std::unique_ptr<ElementGroup> wall_group(const Model& model);

/// The law between two particles that have a Hertz table.
HertzContact hertz_contact(const Model& model, int table, int i, int j);

}  // namespace elamin
