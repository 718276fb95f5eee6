#include "input/grains.hpp"

#include "input/grains_file.hpp"
#include "input/mistakes.hpp"
#include "input/stiffness.hpp"

#include <algorithm>

namespace elamin {

void describe(Keys& keys, GrainsTable& t) {
  keys.about("Free spheres.");
  keys.name("name", t.name, "their name, which is a group too");
  keys.may("from_stage", t.from_stage, "the stage they are there from; by default from the start");
  keys.may("positions", t.positions, "their centres");
  keys.may_file("file", t.file, "a table of commas: x,y,z, and a diameter if there is a fourth column");
  keys.may("diameter", t.diameter, "of all of them [length]; needed unless the file has it", range::positive);
  keys.may("density", t.density, "[mass/length³]; gravity and dynamics need it", range::positive);
  describe_own_values(keys, t.values, false);
  keys.at_most_one({"positions", "file"});
  keys.one_at_least({"positions", "file"}, "give positions = [[x, y, z], …] or file = \"grains.csv\"");
}

void check(GrainsTable& g, Mistakes& mistakes) {
  if (g.place.written("positions") && !g.place.written("file") && !g.place.written("diameter"))
    mistakes.add(g.place, "diameter", "is missing; it must be a positive number");
}

std::optional<Grains> built(const GrainsTable& table, Mistakes& mistakes) {
  GrainRows rows;
  if (table.positions) {
    rows.position = *table.positions;
  } else {
    try {
      rows = read_grains(table.file);
    } catch (const InputError& e) {
      mistakes.add(e.mistakes());
      return std::nullopt;
    }
  }
  if (rows.diameter.empty() != table.diameter.has_value()) {
    mistakes.add(table.place, "diameter",
                  table.diameter ? "stands in the fourth column of the file; leave it out"
                                 : "is missing; give it here, or as a fourth column of the file");
    return std::nullopt;
  }
  if (rows.diameter.empty()) rows.diameter.assign(rows.position.size(), *table.diameter);
  Grains g{table.name, Field(3, rows.position.size()), std::move(rows.diameter), table.density.value_or(0)};
  double farthest = 0;
  for (std::size_t i = 0; i < rows.position.size(); ++i) {
    g.position.col(static_cast<Eigen::Index>(i)) = rows.position[i];
    farthest = std::max(farthest, rows.position[i].cwiseAbs().maxCoeff());
  }
  const double smallest = *std::min_element(g.diameter.begin(), g.diameter.end());
  if (lost(table.place, "diameter", smallest, farthest, mistakes)) return std::nullopt;
  return g;
}

}  // namespace elamin
