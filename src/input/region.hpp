#pragma once
// Regions of space, of groups and of walls.
#include "input/keys.hpp"
#include "laws/region.hpp"


namespace elamin {

/// The keys of a region stand among those of its table, after them: each shape has its own.
void describe_region(Keys& keys, Region& r);

/// A region that is turned inside out is a mistake; `flat`: it may be without extent (a layer that chooses particles).
void check_region(TablePlace& place, const Region& region, bool flat, Mistakes& mistakes);

/// The region with a normal of length 1, if it has one.
Region with_unit_normal(Region region);

}  // namespace elamin
