#pragma once
// What bounds a step of a solver besides the energy itself.
#include "energy/energy.hpp"

namespace elamin {

/// Largest |s_j − s_i|/|x_j − x_i| over the bonds: how much a step (dofs) turns or stretches what is glued; what is driven
/// moves with a change of the load factor.
double distortion(const Energy& energy, const State& state, const Vector& step, double load_change = 0);

/// Largest movement of a particle in its own diameters.
double movement(const Energy& energy, const Vector& step);

/// The distortion of a step; where nothing turns or stretches, its movement.
double step_size(const Energy& energy, const State& state, const Vector& step, double load_change = 0);

/// The extent of all particles and of the finite corners of walls where there are contacts or walls, else infinity: no
/// single step should be longer. [length]
double extent(const Model& model);

/// What has moved farther than that from the start, "particle 7 of 'grains' moves away without end; …" with what to do; else "".
std::string escaped(const Model& model, const State& state, double far);

/// The first grain that a force drives and no stiffness holds, at the last evaluation with Hessian; else "".
std::string falling(const Energy& energy);

/// Which free particle is on the other side of a wall, "the centre of … is pressed through the wall '…'; …"; else "".
std::string gone_through(const Energy& energy, const State& state);

/// What no solver gets over at this state, one phrase with what to try: a centre that is pressed onto a wall or onto another one, two
/// particles at the cutoff of a cohesion whose energy jumps there, glued ones in one place, bodies that touch by a force that leaps; "" if
/// nothing of that is there.
std::string obstacle(const Energy& energy, const State& state);

}  // namespace elamin
