#pragma once
// What the files of the tables give to check_problem and build_model.
#include "input/group.hpp"
#include "input/keys.hpp"
#include "input/names.hpp"
#include "input/problem.hpp"
#include "model/connect.hpp"
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

// What can be said before anything is built, table after table; see check_problem.

/// Beams, loops, sheets, grains: what goes together, their names, how many they are together.
void check_structures(Problem& problem, Names& names, Mistakes& mistakes);
/// Rigid bodies, and their names.
void check_bodies(Problem& problem, Names& names, Mistakes& mistakes);
/// Groups and how they choose, in the order of the file.
void check_groups(Problem& problem, Names& names, Mistakes& mistakes);
/// How supports hold and move.
void check_supports(Problem& problem, Names& names, Mistakes& mistakes);
/// Loads, gravity, pressures, changes; the names of conditions, and those that [path] parameter chooses.
void check_loads(Problem& problem, Names& names, Mistakes& mistakes);
/// Viscosity, velocities, and the motion in time.
void check_motion(Problem& problem, Names& names, Mistakes& mistakes);
/// Whether the method can do what the study asks for.
void check_solver(Problem& problem, Mistakes& mistakes);
/// The path, its stages and the events that are looked for on it.
void check_path(Problem& problem, Mistakes& mistakes);
/// The curve that is asked for; why no row of it is meant by `at`, or "".
void check_curve(Problem& problem, Mistakes& mistakes);
std::string wrong_at_curve(const Problem& problem, const std::string& at);
/// What cannot be refined.
void check_refine(Problem& problem, Mistakes& mistakes);
/// The landscape that is asked for; why no row of it is meant by `at`, or "".
void check_landscape(Problem& problem, Mistakes& mistakes);
std::string wrong_at_landscape(const Problem& problem, const std::string& at);
/// Connections, bonds, angles, and what is removed.
void check_connections(Problem& problem, Names& names, Mistakes& mistakes);
void check_contacts(Problem& problem, Names& names, Mistakes& mistakes);
/// Walls, and their names.
void check_walls(Problem& problem, Names& names, Mistakes& mistakes);
/// What is observed and expected.
void check_results(Problem& problem, Names& names, Mistakes& mistakes);
void check_expectations(Problem& problem, Mistakes& mistakes);

// From tables to the model. What returns a bool tells whether all could be built.

/// Adds beams, loops, sheets and grains, in this order, to what the model holds. One that cannot be built is told and
/// its name goes to left_out. False, and nothing is added, if they are too many for this machine.
bool add_structures(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes);

/// Where the table of a structure stands.
const TablePlace& place_of(const Problem& problem, const Structure& structure);

/// Adds the bodies of the [[body]] tables. One that cannot be built is told and its name goes to left_out.
void add_bodies(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes);

/// Adds what bodies carry. A mistake: a group without particles, a body that is none or several, a particle glued twice.
bool add_glue(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds the bonds and angles of the connections, and of the tables of bonds and of angles, that are made before the first stage. A mistake: one
/// that makes no bond.
bool add_connections(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// What a table says, without the particles of its groups.
Connection connection_of(const ConnectTable& table);
/// The bonds of a table with pairs or a file. `sides`: the particles of its groups, of which it counts, or null: it has ids. Mistakes: a
/// particle that there is not, a bond to itself, of two in one place without a rest length, twice, or where the model has one already.
std::vector<NewBond> listed_bonds(const BondsTable& t, const std::array<std::vector<int>, 2>* sides, const Model& model, Mistakes& mistakes);
/// The angles of a table; `over`: the particles of its group. Mistakes as of bonds.
std::vector<NewAngle> listed_angles(const AnglesTable& t, const std::vector<int>& over, const Model& model, Mistakes& mistakes);

/// Adds the supports. A mistake: two that prescribe one coordinate differently; one that leaves the plane; one rotation held alone.
bool add_supports(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds loads, gravity, pressures and changes. A mistake: a force out of the plane; a radial one on the axis; gravity on particles without
/// density or bodies without mass; a change of nothing, or to nothing.
void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds viscosity, and velocities at the start.
void add_motion(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds contacts, of rounded bodies too; walls. A mistake: groups without what a law is between; particles without diameter that would
/// touch; a wall without the numbers of what its group has.
bool add_contacts(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);
bool add_walls(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

// What must hold of the whole model.

/// Every particle and body must have a mass, or that is told; of dynamics.
void need_masses(const Problem& problem, const Model& model, Mistakes& mistakes);

/// A vector that has a component along the normal of the plane is a mistake; an axial one that has any other.
void stay_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v, Mistakes& mistakes);
void turn_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v, Mistakes& mistakes);

/// A mistake: glued particles that something else holds, presses on or keeps apart; pairs of bodies that no table of the law
/// "rounded" speaks of, where there is one; what only particles, or only potentials, can have.
void check_bodies_built(const Problem& problem, const Model& model, Mistakes& mistakes);

/// Particles and bodies whose centres start on the wrong side of their wall are a mistake: nothing would push them back. A wall
/// with open faces acts on both sides; an energy study may have any state.
void check_sides(const Problem& problem, const Model& model, Mistakes& mistakes);

/// Two particles in one place (closer than 1e-9 of their smaller diameter), told once for each pair of structures.
/// Inside a LAMMPS data file it is allowed in an energy study.
void check_distinct(const Problem& problem, const Model& model, Mistakes& mistakes);

/// Particles and bodies that are not in one plane, where the problem asks for it.
void check_plane(const Problem& problem, const Model& model, const State& state, const TablePlace& whose, Mistakes& mistakes);

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
