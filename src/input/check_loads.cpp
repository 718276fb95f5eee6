#include "input/check_parts.hpp"
#include "input/check_region.hpp"
#include "input/conditions.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace elamin {
namespace {

void check_load(const Problem& problem, LoadTable& l, Mistakes& mistakes) {
  const auto written = [&](const char* key) { return l.place.keys.count(key) > 0; };
  std::string first;
  for (const char* key : {"force", "total_force", "radial"}) {
    if (!written(key)) continue;
    if (first.empty()) first = key;
    else mistakes.add(l.place, key, first + " is there too; give one of them");
  }
  if (written("point") && (first.empty() || written("radial")))
    mistakes.add(l.place, "point", "is of no use without force or total_force, which act there");
  if (first.empty() && !written("torque"))
    mistakes.add(l.place, "force, total_force or radial is missing; give one of them: a list of three numbers [x, y, z], "
                          "or for radial a number; on bodies also torque");
  if (!written("radial")) {
    for (const char* key : {"center", "axis"})
      if (written(key)) mistakes.add(l.place, key, "is of no use without radial, the force away from an axis");
  } else if (l.axis) {
    check_direction(l.place, "axis", *l.axis, mistakes);
  } else if (problem.plane.empty() && !written("axis")) {
    mistakes.add(l.place, "axis", "is missing; it must be a list of three numbers [x, y, z], as the problem has no plane");
  }
}

void check_pressure(const Problem& problem, PressureTable& p, Mistakes& mistakes) {
  if (p.loop.empty() && p.place.broken) return;
  std::vector<std::string> loops;
  for (const LoopTable& l : problem.loops) loops.push_back(l.name);
  if (std::find(loops.begin(), loops.end(), p.loop) == loops.end())
    mistakes.add(p.place, "loop",
                 in_quotes(p.loop) + " is no [[loop]]; " + (loops.empty() ? "there is none" : "there are: " + listed(loops)) +
                     did_you_mean(p.loop, loops));
}

void check_change(ChangeTable& c, Mistakes& mistakes) {
  const auto written = [&](const char* key) { return c.place.keys.count(key) > 0; };
  if (!written("rest_length") && !written("bond_stiffness") && !written("angle_stiffness"))
    mistakes.add(c.place, "rest_length, bond_stiffness or angle_stiffness is missing; give one or more, each the relative "
                          "change at load factor 1");
}

/// Names of conditions are unique among their kind; walls have theirs among the groups.
void check_names(const Problem& problem, Mistakes& mistakes) {
  std::set<std::string> taken;
  for (const Condition& c : conditions_of(problem))
    if (!c.name.empty() && c.kind != "wall" && !taken.insert(c.label()).second)
      mistakes.add(c.place, "name", in_quotes(c.name) + " is the name of another [[" + c.kind + "]]; names are unique");
}

void check_parameter(Problem& problem, Mistakes& mistakes) {
  const std::vector<Condition> conditions = conditions_of(problem);
  std::vector<std::string> labels;
  for (const Condition& c : conditions) labels.push_back(c.label());
  std::set<int> chosen;
  for (const std::string& word : problem.path.parameter) {
    const int found = find_condition(conditions, word);
    if (found < 0)
      mistakes.add(problem.path.place, "parameter",
                   in_quotes(word) + " names no table that a load factor scales; " +
                       (labels.empty() ? "there is none" : "there are: " + listed(labels)) + did_you_mean(word, labels));
    else if (!chosen.insert(found).second)
      mistakes.add(problem.path.place, "parameter", in_quotes(word) + " is there twice; once is enough");
  }
}

}  // namespace

void check_loads(Problem& problem, Names& names, Mistakes& mistakes) {
  for (LoadTable& l : problem.loads) {
    names.refer(l.place, "group", l.group);
    check_load(problem, l, mistakes);
  }
  for (GravityTable& g : problem.gravity) names.refer(g.place, "group", g.group);
  for (PressureTable& p : problem.pressures) check_pressure(problem, p, mistakes);
  for (ChangeTable& c : problem.changes) {
    names.refer(c.place, "group", c.group);
    check_change(c, mistakes);
  }
  check_names(problem, mistakes);
  check_parameter(problem, mistakes);
}

}  // namespace elamin
