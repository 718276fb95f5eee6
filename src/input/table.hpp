#pragma once
// What every table of a problem file has, and what its keys may hold.
#include "core/place.hpp"

#include <limits>
#include <map>
#include <string>

namespace elamin {

class Groups;
class Mistakes;
class Names;
struct Problem;

/// Where a table and its keys stand, for messages that come after reading. It is not part of what the file says:
/// two tables that say the same are equal wherever they stand.
struct TablePlace : Place {
  std::string key;                              // what `--set` calls the table: "beam.column", "support.2", "path"
  std::map<std::string, Place> keys;            // of those that are written
  bool broken = false;                          // a mistake was found in it
  bool written(const char* name) const { return keys.count(name) > 0; }
  bool operator==(const TablePlace&) const { return true; }
};

/// What a number may be: lo ≤ x ≤ hi, or lo < x ≤ hi.
struct Range {
  double lo = -std::numeric_limits<double>::max(), hi = std::numeric_limits<double>::max();
  bool above = false;
};
inline constexpr int most_particles = 100'000'000, most_steps = 1'000'000, most_branches = 1000, most_modes = 1000;
namespace range {
inline constexpr Range any{}, positive{0, any.hi, true}, not_negative{0}, count{1, most_particles};
inline constexpr Range id{1, std::numeric_limits<int>::max()};
inline constexpr Range poissons_ratio{-1, 0.5, true}, degrees{0, 180};
}  // namespace range

/// A word of the file and what it stands for.
template <class T> struct Word {
  const char* text;
  T value;
};

/// Films of a run's states, by the ends of their names.
inline constexpr Word<const char*> film_words[]{{"lammpstrj", "lammpstrj"}, {"pvd", "pvd"}, {"xyz", "xyz"}};

}  // namespace elamin
