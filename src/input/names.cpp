#include "input/names.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

namespace elamin {

bool is_type_group(const std::string& name) {
  return name.size() > 4 && name.compare(0, 4, "type") == 0 && name.find_first_not_of("0123456789", 4) == std::string::npos;
}

std::string named(const TablePlace& place) {
  return place.line > 0 ? fmt::format("{} of line {}", place.key, place.line) : place.key;
}

Names::Names(const Problem& problem, const std::vector<std::string>& others, Mistakes& mistakes)
    : problem_(problem), others_(others.begin(), others.end()), mistakes_(mistakes) {
  if (!problem.lammps) return;
  groups_["lammps"] = problem.lammps->place;
  for (const auto& label : problem.lammps->labels) groups_[label.first] = problem.lammps->place;
}

void Names::add(TablePlace& place, const std::string& name, Places& to) {
  if (name.empty()) return;
  if (name == "all" || name == "lammps" || is_type_group(name))
    return mistakes_.add(place, "name", in_quotes(name) + " is reserved; \"all\", \"lammps\" and \"type1\", \"type2\", … name themselves");
  for (const Places* places : {&groups_, &walls_})
    if (const auto first = places->find(name); first != places->end())
      return mistakes_.add(place, "name", in_quotes(name) + " is taken by " + named(first->second) + "; names are unique");
  to.emplace(name, place);
}

void Names::refer(TablePlace& place, const char* key, const std::string& name, bool or_wall) {
  if (!place.keys.count(key) || (name.empty() && place.broken)) return;   // the default; or missing, and said so
  if (name == "all" || groups_.count(name) || others_.count(name) || (problem_.lammps && is_type_group(name))) return;
  if (or_wall && is_wall(name)) return;
  std::vector<std::string> known{"all"};
  for (const auto& entry : groups_) known.push_back(entry.first);
  if (find_named(problem_.groups, name))
    return mistakes_.add(place, key, in_quotes(name) + " comes further down; a group is made of those before it");
  if (find_named(problem_.walls, name))
    return mistakes_.add(place, key, in_quotes(name) + " is a wall, not a group; there are: " + listed(known));
  if (problem_.lammps) known.push_back("type1");
  for (const auto& entry : walls_)
    if (or_wall) known.push_back(entry.first);
  const char* const what = or_wall && !walls_.empty() ? " names no group and no wall; there are: " : " names no group; there are: ";
  mistakes_.add(place, key, in_quotes(name) + what + listed(known) + did_you_mean(name, known));
}

void Names::refer(TablePlace& place, const char* key, const std::array<std::string, 2>& names) {
  if (names[0].empty() && names[1].empty()) return;   // could not be read, and said so
  refer(place, key, names[0]);
  if (names[1] != names[0]) refer(place, key, names[1]);
}

}  // namespace elamin
