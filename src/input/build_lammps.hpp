#pragma once
// From LAMMPS data files to a model: what [lammps] names, and the state that a path goes on from.
#include "model/model.hpp"
#include "input/mistakes.hpp"
#include "input/problem.hpp"

namespace elamin {

/// Takes particles, bonds, angles and bodies of [lammps] into the model, which is empty yet. False: they are not known;
/// why was told.
bool add_lammps(const Problem& problem, Model& model, Mistakes& mistakes);

/// What the files of [lammps] hold and the model has not, in sentences, and warnings of coefficients that were rounded. Reads them again.
struct LammpsRemarks { std::vector<std::string> notes, warnings; };
LammpsRemarks lammps_remarks(const Problem& problem);

/// Model::restart from path.start, a state of this model: positions, poses and in dynamics velocities, to the last bit where
/// LABEL.json stands beside. Without it the bodies are turned as their vertices tell.
void add_restart(const Problem& problem, Model& model, Mistakes& mistakes);

}  // namespace elamin
