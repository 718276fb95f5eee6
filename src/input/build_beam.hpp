#pragma once
// From the table of a beam to where its particles are.
#include "model/centerline.hpp"
#include "input/mistakes.hpp"
#include "input/problem.hpp"

#include <optional>
#include <string>

namespace elamin {

/// Neighbours must be told apart by doubles, or every length is rounding: whether `length` is lost beside the farthest
/// coordinate; then it is told as a mistake.
bool lost(const TablePlace& place, const char* what, double length, double farthest, Mistakes& mistakes);

/// The ends of the beam beyond which one particle more stands.
Clamped clamped_ends(const BeamTable& table);

/// Where the particles of a beam are; none, and said why, if they cannot be there. plane: "", "xy", "xz" or "yz".
std::optional<Centerline> centerline_of(const BeamTable& table, const std::string& plane, Mistakes& mistakes);

}  // namespace elamin
