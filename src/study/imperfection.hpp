#pragma once
// The model of a problem, with the imperfection that it asks for.
#include "input/problem.hpp"
#include "model/model.hpp"

namespace elamin {

/// build_model, and every particle of [imperfection] group moved as the table says: by modes as built, held and unloaded (or of a stored
/// run), each with its largest displacement its amplitude, the largest component of it positive; by scale times the difference of a stored
/// state from the perfect shape; or at random (mt19937_64; uniform in ±random, or normal with that deviation). In a plane nothing leaves
/// it; particles that a body carries stay. Throws InputError.
Model model_of(const Problem& problem, const std::vector<OwnLaw>& own = {});

}  // namespace elamin
