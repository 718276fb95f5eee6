#pragma once
// The study of a threshold as a second parameter changes: what [curve] asks for.
#include "input/problem.hpp"
#include "model/model.hpp"
#include "path/curve.hpp"
#include "study/trace.hpp"

namespace elamin {

/// The model in force at a value of the second parameter. Throws InputError where the problem file with that value is wrong.
using ModelAt = std::function<Model(double second)>;

/// Follows the event that a path has ended at; every point of the curve and everything that happens on it is a row of curve_columns. Where
/// the structure cannot be made, or has other particles, bonds or coordinates, the curve ends and the outcome says so.
Outcome trace_curve(const Problem& problem, const ModelAt& models, const PathPoint& event,
                    const std::function<void(const Row&, const Threshold&)>& found);

}  // namespace elamin
