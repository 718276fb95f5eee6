#pragma once
// Why a path ends where it cannot be followed any further.
#include "path/equilibrium.hpp"

namespace elamin {

/// What at the last equilibrium is likely to keep a path from going on, with what to change: an angle without a sign that is flat, a
/// contact that is just made or lost, a limit point or branch point that is near; one sentence, or "" where nothing of these is seen.
std::string cause_at(Newton& newton, const Equilibrium& last);

}  // namespace elamin
