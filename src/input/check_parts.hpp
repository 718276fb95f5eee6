#pragma once
// The parts of check_problem, and the names that they share.
#include "input/mistakes.hpp"
#include "input/problem.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace elamin {

/// "support.2 of line 7", or without the line if it came from the command line.
std::string named(const TablePlace& place);

/// Names of structures, groups and walls, as far as they have been entered.
class Names {
 public:
  /// `others`: names of structures that were refused, so that their groups are not missed too.
  Names(const Problem& problem, const std::vector<std::string>& others, Mistakes& mistakes);

  /// Enters the name of a structure or a group, or of a wall; it must be new.
  void add(TablePlace& place, const std::string& name) { add(place, name, groups_); }
  void add_wall(TablePlace& place, const std::string& name) { add(place, name, walls_); }
  bool is_wall(const std::string& name) const { return walls_.count(name) > 0; }

  /// A reference to a group that must be there already; or_wall: or to a wall.
  void refer(TablePlace& place, const char* key, const std::string& name, bool or_wall = false);
  void refer(TablePlace& place, const char* key, const std::array<std::string, 2>& names);

 private:
  using Places = std::map<std::string, TablePlace>;
  void add(TablePlace& place, const std::string& name, Places& to);

  const Problem& problem_;
  std::set<std::string> others_;
  Mistakes& mistakes_;
  Places groups_, walls_;
};

/// Beams, loops, sheets, grains: what goes together, their names, how many they are together.
void check_structures(Problem& problem, Names& names, Mistakes& mistakes);

/// Rigid bodies.
void check_bodies(Problem& problem, Names& names, Mistakes& mistakes);

/// What particles bodies carry, and the laws and walls of bodies.
void check_rounded(Problem& problem, Names& names, Mistakes& mistakes);

/// Groups and how they choose, in the order of the file.
void check_groups(Problem& problem, Names& names, Mistakes& mistakes);

/// Connections, contacts and walls.
void check_interactions(Problem& problem, Names& names, Mistakes& mistakes);

/// Loads, gravity, pressures, changes; the names of conditions, and those that [path] parameter chooses.
void check_loads(Problem& problem, Names& names, Mistakes& mistakes);

/// The path, its stages and the events that are looked for on it.
void check_path(Problem& problem, Mistakes& mistakes);

/// What is observed and expected.
void check_results(Problem& problem, Names& names, Mistakes& mistakes);

}  // namespace elamin
