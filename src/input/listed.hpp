#pragma once
// Bonds and angles that are given one by one, or over bonds.
#include "input/mistakes.hpp"
#include "input/problem.hpp"
#include "model/connect.hpp"

namespace elamin {

/// The bonds of a table with pairs or a file. `sides`: the particles of its groups, of which it counts, or null: it has ids. Mistakes: a
/// particle that there is not, a bond to itself, of two in one place without a rest length, twice, or where the model has one already.
std::vector<NewBond> listed_bonds(const BondsTable& t, const std::array<std::vector<int>, 2>* sides, const Model& model, Mistakes& mistakes);

/// The angles of a table; `over`: the particles of its group. Mistakes as of bonds.
std::vector<NewAngle> listed_angles(const AnglesTable& t, const std::vector<int>& over, const Model& model, Mistakes& mistakes);

/// What must be there together in such tables.
void check_listed(BondsTable& t, Mistakes& mistakes);
void check_listed(AnglesTable& t, Mistakes& mistakes);

}  // namespace elamin
