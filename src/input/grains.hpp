#pragma once
// Free spheres.
#include "input/keys.hpp"
#include "model/grains.hpp"


namespace elamin {

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
