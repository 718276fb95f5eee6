#pragma once
// Regions, of groups and of walls.
#include "input/mistakes.hpp"
#include "input/problem.hpp"

namespace elamin {

/// A direction that is zero is a mistake.
void check_direction(TablePlace& place, const char* key, const Vec3& direction, Mistakes& mistakes);

/// A region that is turned inside out is a mistake; `flat`: it may be without extent (a layer that chooses particles).
void check_region(TablePlace& place, const Region& region, bool flat, Mistakes& mistakes);

/// "plane", "block", …
const char* name_of(Shape shape);

}  // namespace elamin
