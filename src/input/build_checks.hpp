#pragma once
// What must hold of the structure as a whole before anything is computed with it.
#include "model/model.hpp"
#include "input/groups.hpp"

namespace elamin {

/// Two particles in one place (closer than 1e-9 of their smaller diameter), told once for each pair of structures.
/// Inside a LAMMPS data file it is allowed in an energy study.
void check_distinct(const Problem& problem, const Model& model, Mistakes& mistakes);

/// Particles and bodies that are not in one plane, where the problem asks for it.
void check_plane(const Problem& problem, const Model& model, const State& state, const TablePlace& whose,
                 Mistakes& mistakes);

/// What cannot be an equilibrium. Glued parts that neither a support nor, by its tables, a wall or a contact may hold
/// are told once a structure; a single particle only if a force acts on it. Parts that only touch each other are fine
/// as long as the forces on them cancel. What is held, and by supports only, may not move as a whole.
void check_held(const Problem& problem, const Model& model, Mistakes& mistakes);

/// A study cannot have more modes or eigenvalues than there are free coordinates.
void check_modes(const Problem& problem, const Model& model, Mistakes& mistakes);

/// What is observed of a group that has it not: a gap of what touches nothing, a tension without bonds, a slope of one particle. Bonds that
/// come with a stage are not known yet, then nothing is said of them.
void check_observed(const Problem& problem, Groups& groups, const Model& model, Mistakes& mistakes);

/// Of dynamics: the timestep must be a stable one at the starting state, or be allowed not to be.
void check_timestep(const Problem& problem, const Model& model, Mistakes& mistakes);

}  // namespace elamin
