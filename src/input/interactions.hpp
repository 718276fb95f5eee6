#pragma once
// What touches and glues particles besides the structures they were built in: connections, contacts, walls.
#include "model/connect.hpp"
#include "input/groups.hpp"

namespace elamin {

/// What a table says, without the particles of its groups.
Connection connection_of(const ConnectTable& table);

/// Adds the bonds and angles of the connections, and of the tables of bonds and of angles, that are made before the first stage. A mistake: one
/// that makes no bond. Returns whether all could be built.
bool add_connections(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Adds contacts, of rounded bodies too, and walls. A mistake: groups without what a law is between; particles without diameter
/// that would touch; a wall without the numbers of what its group has. Returns whether all could be built.
bool add_contacts(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes);

/// Particles and bodies whose centres start on the wrong side of their wall are a mistake: nothing would push them back. A wall
/// with open faces acts on both sides; an energy study may have any state.
void check_sides(const Problem& problem, const Model& model, Mistakes& mistakes);

}  // namespace elamin
