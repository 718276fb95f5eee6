#pragma once
// Which solver a problem asks for.
#include "path/options.hpp"
#include "input/problem.hpp"
#include "solve/method.hpp"

namespace elamin {

NewtonOptions solver_options(const Problem& problem);

/// What solver.method and its keys ask for; of damped dynamics, which is no Method, Newton's.
Method solver_method(const Problem& problem);

/// Finds a minimum near a state by the problem's method: not a saddle. `newton` must outlive it.
Corrector minimiser_of(const Problem& problem, Newton& newton);

/// Finds an equilibrium near a state by the problem's method, for load steps; none where that is Newton's own.
Corrector corrector_of(const Problem& problem, Newton& newton);

}  // namespace elamin
