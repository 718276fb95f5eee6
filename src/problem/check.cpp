#include "problem/check.hpp"

#include "problem/check_parts.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

namespace elamin {

bool is_type_group(const std::string& name) {
  return name.size() > 4 && name.compare(0, 4, "type") == 0 &&
         name.find_first_not_of("0123456789", 4) == std::string::npos;
}

std::string named(const TablePlace& place) {
  return place.line > 0 ? fmt::format("{} of line {}", place.key, place.line) : place.key;
}

Names::Names(const Problem& problem, const std::vector<std::string>& others, Mistakes& mistakes)
    : problem_(problem), others_(others.begin(), others.end()), mistakes_(mistakes) {
  if (problem.lammps) groups_["lammps"] = problem.lammps->place;
}

void Names::add(TablePlace& place, const std::string& name, Places& to) {
  if (name.empty()) return;
  if (name == "all" || name == "lammps" || is_type_group(name))
    return mistakes_.add(
        place, "name", quoted(name) + " is reserved; \"all\", \"lammps\" and \"type1\", \"type2\", … name themselves");
  for (const Places* places : {&groups_, &walls_})
    if (const auto first = places->find(name); first != places->end())
      return mistakes_.add(place, "name",
                           quoted(name) + " is taken by " + named(first->second) + "; names are unique");
  to.emplace(name, place);
}

void Names::refer(TablePlace& place, const char* key, const std::string& name, bool or_wall) {
  if (!place.keys.count(key) || (name.empty() && place.broken)) return;   // the default; or missing, and said so
  if (name == "all" || groups_.count(name) || others_.count(name) || (problem_.lammps && is_type_group(name))) return;
  if (or_wall && is_wall(name)) return;
  std::vector<std::string> known{"all"};
  for (const auto& entry : groups_) known.push_back(entry.first);
  for (const GroupTable& g : problem_.groups)
    if (g.name == name)
      return mistakes_.add(place, key, quoted(name) + " comes further down; a group is made of those before it");
  for (const WallTable& w : problem_.walls)
    if (w.name == name)
      return mistakes_.add(place, key, quoted(name) + " is a wall, not a group; there are: " + listed(known));
  if (problem_.lammps) known.push_back("type1");
  for (const auto& entry : walls_)
    if (or_wall) known.push_back(entry.first);
  mistakes_.add(place, key,
                quoted(name) + (or_wall && !walls_.empty() ? " names no group and no wall" : " names no group") +
                    "; there are: " + listed(known) + did_you_mean(name, known));
}

void Names::refer(TablePlace& place, const char* key, const std::array<std::string, 2>& names) {
  if (names[0].empty() && names[1].empty()) return;   // could not be read, and said so
  refer(place, key, names[0]);
  if (names[1] != names[0]) refer(place, key, names[1]);
}

namespace {

void check_support(SupportTable& s, Mistakes& mistakes) {
  const std::string& d = s.directions;
  std::set<char> letters(d.begin(), d.end());
  if (d.empty() || letters.size() != d.size() || d.find_first_not_of("xyz") != std::string::npos)
    return mistakes.add(s.place, "directions",
                        "must be one, two or three of the letters x, y and z, is " + quoted(d));
  for (int c = 0; c < 3; ++c)
    if (s.displacement[c] != 0 && !letters.count("xyz"[c]))
      mistakes.add(s.place, "displacement", fmt::format("moves along {}, which is not among the directions \"{}\"; "
                                                        "give 0 there or hold that direction", "xyz"[c], d));
}

void check_load(LoadTable& l, Mistakes& mistakes) {
  const bool tried = l.place.keys.count("force") || l.place.keys.count("total_force");
  if (l.force && l.total_force)
    mistakes.add(l.place, "total_force", "force is there too; give one of them");
  else if (!l.force && !l.total_force && !tried)
    mistakes.add(l.place, "force or total_force is missing; give one of them, a list of three numbers [x, y, z]");
}

void check_path(PathTable& t, bool is_path, Mistakes& mistakes) {
  if (t.place.broken) return;
  if (t.from == t.to)
    mistakes.add(t.place, "to",
                 fmt::format("is the same load factor as from, {}; a path leads from one to another", t.to));
  if (t.start_lambda && t.start.empty())
    mistakes.add(t.place, "start_lambda", "is of no use without start, the state to start from");
  if (is_path && t.start_lambda && *t.start_lambda == t.to && t.from != t.to)
    mistakes.add(t.place, "start_lambda",
                 fmt::format("is the load factor where the path ends, {}; a path leads from one to another", t.to));
}

}  // namespace

void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes) {
  Names names(problem, other_names, mistakes);
  check_structures(problem, names, mistakes);
  check_groups(problem, names, mistakes);
  for (SupportTable& s : problem.supports) {
    names.refer(s.place, "group", s.group);
    check_support(s, mistakes);
  }
  for (LoadTable& l : problem.loads) {
    names.refer(l.place, "group", l.group);
    check_load(l, mistakes);
  }
  for (GravityTable& g : problem.gravity) names.refer(g.place, "group", g.group);
  for (ViscosityTable& v : problem.viscosity) names.refer(v.place, "group", v.group);
  check_path(problem.path, problem.study == StudyType::path, mistakes);
  check_interactions(problem, names, mistakes);
  check_results(problem, names, mistakes);
}

}  // namespace elamin
