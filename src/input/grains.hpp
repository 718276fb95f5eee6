#pragma once
// Free spheres.
#include "core/types.hpp"
#include "input/keys.hpp"
#include "model/grains.hpp"

#include <string>
#include <vector>

namespace elamin {

// Positions of grains from a table.

struct GrainRows {
  std::vector<Vec3> position;          // [length]
  std::vector<double> diameter;        // of each, or empty: the file has no fourth column
};

/// Reads a table of commas: x,y,z or x,y,z,diameter, a grain a line. Blank lines, what follows '#', and one line of
/// names at the beginning are left out. Throws InputError with file, line and column of up to 20 mistakes; holds at
/// least one grain.
GrainRows read_grains(const std::string& file);

struct GrainsTable {
  TablePlace place;
  std::string name, from_stage, values;
  std::optional<std::vector<Vec3>> positions;   // either these …
  std::string file;                             // … or this
  std::optional<double> diameter, density;
  bool operator==(const GrainsTable&) const = default;
};

void describe(Keys& keys, GrainsTable& t);
void check(GrainsTable& t, Mistakes& mistakes);
/// The grains; none, and said why, if they cannot be built.
std::optional<Grains> built(const GrainsTable& t, Mistakes& mistakes);

}  // namespace elamin
