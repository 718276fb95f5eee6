#pragma once
// From what the file says to a structure: particles, bonds, angles, who is held and who is loaded.
#include "model/model.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"

namespace elamin {

/// Builds the model. Particles, in this order: those of the LAMMPS data file with their own ids and types, then beam
/// after beam, with new ids, types and molecules counting on. Groups: "all", the structures, "type1", … of the data
/// file, then the named ones. Model::start is the reference configuration at load factor path.from; Model::restart is
/// path.start. `own`: laws that the program brings along; Model::own. Throws InputError with all mistakes.
Model build_model(const Problem& problem, const std::vector<OwnLaw>& own = {});

/// Builds and forgets the model: adds to the mistakes what build_model would throw, leaving out broken tables and what
/// depends on them. `whole`: no structure of the file is missing from the problem.
void check_model(const Problem& problem, bool whole, Mistakes& mistakes);

}  // namespace elamin
