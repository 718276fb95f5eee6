#pragma once
// Positions of grains from a table.
#include "core/types.hpp"

#include <string>
#include <vector>

namespace elamin {

struct GrainRows {
  std::vector<Vec3> position;          // [length]
  std::vector<double> diameter;        // of each, or empty: the file has no fourth column
};

/// Reads a table of commas: x,y,z or x,y,z,diameter, a grain a line. Blank lines, what follows '#', and one line of
/// names at the beginning are left out. Throws InputError with file, line and column of up to 20 mistakes; holds at
/// least one grain.
GrainRows read_grains(const std::string& file);

}  // namespace elamin
