#pragma once
// The names of what a problem file holds, and references to them.
#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace elamin {

/// Whether a name is "type" and a number: the groups of a LAMMPS data file.
bool is_type_group(const std::string& name);

/// "support.2 of line 7", or without the line if it came from the command line.
std::string named(const TablePlace& place);

/// A mistake of a key that names none of these tables [[kind]].
template <class Tables>
void must_be_one(const Tables& tables, const std::string& kind, TablePlace& place, const char* key, const std::string& name, Mistakes& mistakes) {
  if (find_named(tables, name)) return;
  std::vector<std::string> names;
  for (const auto& table : tables) names.push_back(table.name);
  mistakes.add(place, key, in_quotes(name) + " is no [[" + kind + "]]; " + there_are(names, name));
}

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

}  // namespace elamin
