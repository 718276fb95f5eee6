#pragma once
// From the tables of rigid bodies to bodies, what they carry, and what must hold of how they feel each other.
#include "input/groups.hpp"

namespace elamin {

/// Adds the bodies of the [[body]] tables. One that cannot be built is told and its name goes to left_out.
void add_bodies(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes);

/// Adds what bodies carry. A mistake: a group without particles, a body that is none or several, a particle glued twice. Returns
/// whether all could be glued.
bool add_glue(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// A mistake: glued particles that something else holds, presses on or keeps apart; pairs of bodies that no table of the law
/// "rounded" speaks of, where there is one; what only particles, or only potentials, can have.
void check_bodies_built(const Problem& problem, const Model& model, Mistakes& mistakes);

}  // namespace elamin
