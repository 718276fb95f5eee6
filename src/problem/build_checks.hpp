#pragma once
// What must hold of the structure as a whole before anything is computed with it.
#include "model/model.hpp"
#include "problem/mistakes.hpp"
#include "problem/problem.hpp"

namespace elamin {

/// Two particles in one place (closer than 1e-9 of their smaller diameter), told once for each pair of structures.
/// Inside a LAMMPS data file it is allowed in an energy study.
void check_distinct(const Problem& problem, const Model& model, Mistakes& mistakes);

/// Particles that are not in one plane, where the problem asks for it.
void check_plane(const Problem& problem, const Model& model, const Field& position, const TablePlace& whose,
                 Mistakes& mistakes);

/// Structures that are connected, through bonds and angles, to no held particle: they have no equilibrium of their own.
void check_held(const Problem& problem, const Model& model, Mistakes& mistakes);

}  // namespace elamin
