#pragma once
// What `elamin check` says of a model, in lines for reading.
#include "energy/energy.hpp"
#include "input/problem.hpp"

#include <string>
#include <vector>

namespace elamin {

/// A few lines for each structure and each connection: particles, stiffnesses K and B, and what follows from them of a
///   row    EA = 2 K q₀, EI = B q₀, its ends, the effective length between them and Euler's load
///   loop   EA, EI, radius
///   sheet  Y = 4K/√3 and ν = 1/3 in its plane, D = 3√3/4 B, spacing and size
///   grains diameters and mass
///   body   see describe_bodies
std::string describe_structures(const Problem& problem, const Model& model, const Kinematics& kinematics);

/// Shape, size, volume, mass, inertia and place of the bodies of a structure; of many, a few lines a shape.
std::string describe_bodies(const Model& model, const Structure& structure);

/// Warnings of particles that overlap by more than a quarter of the smaller one, if they feel each other or no bond holds them, and of bodies whose cores
/// overlap, at a state that the energy has been evaluated at, or starts from.
std::vector<std::string> deep_overlaps(const Model& model, Energy& energy, const State& state);

/// Warnings of friction, damping and drag in a study that has no motion.
std::vector<std::string> idle_at_rest(const Problem& problem);

/// Warnings of what a model is silent about: units that look mixed, stiffnesses that reach beyond the digits of a force, rest angles that are
/// not straight where no plane gives them a sign, bonds without stiffness, expectations that nothing at all would meet too, and what acts in
/// dynamics only in a study of equilibria.
std::vector<std::string> doubts(const Problem& problem, const Model& model);

/// Warnings of particles that supports hold in all directions and drive into each other by more than a quarter of a diameter, between the
/// first and the last load factor of a problem without stages (looked at every quarter of a diameter, at most 200 times).
std::vector<std::string> driven_together(const Problem& problem, const Model& model);

/// All warnings of a problem, before anything is solved: doubts, deep overlaps at the state, what supports drive into each other.
std::vector<std::string> warnings(const Problem& problem, const Model& model, Energy& energy, const State& state);

/// One or two lines for each contact law and each wall: its numbers, and who overlaps or is on the wrong side at `state`.
std::string describe_contacts(const Model& model, Energy& energy, const State& state);

/// One line for each radial load, pressure and change, and what the load factor scales if that was chosen.
std::string describe_conditions(const Problem& problem, const Model& model);

/// The fastest vibration at the state, the longest stable timestep, and the one taken beside it.
std::string describe_timestep(Energy& energy, const State& state, double timestep);

/// The rigid motions that the supports leave free; many of them are counted, not named.
std::string describe_motions(const Model& model);

}  // namespace elamin
