#include "input/check.hpp"

#include "input/check_parts.hpp"
#include "input/staged_structure.hpp"
#include "core/suggest.hpp"

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
        place, "name", in_quotes(name) + " is reserved; \"all\", \"lammps\" and \"type1\", \"type2\", … name themselves");
  for (const Places* places : {&groups_, &walls_})
    if (const auto first = places->find(name); first != places->end())
      return mistakes_.add(place, "name",
                           in_quotes(name) + " is taken by " + named(first->second) + "; names are unique");
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
      return mistakes_.add(place, key, in_quotes(name) + " comes further down; a group is made of those before it");
  for (const WallTable& w : problem_.walls)
    if (w.name == name)
      return mistakes_.add(place, key, in_quotes(name) + " is a wall, not a group; there are: " + listed(known));
  if (problem_.lammps) known.push_back("type1");
  for (const auto& entry : walls_)
    if (or_wall) known.push_back(entry.first);
  mistakes_.add(place, key,
                in_quotes(name) + (or_wall && !walls_.empty() ? " names no group and no wall" : " names no group") +
                    "; there are: " + listed(known) + did_you_mean(name, known));
}

void Names::refer(TablePlace& place, const char* key, const std::array<std::string, 2>& names) {
  if (names[0].empty() && names[1].empty()) return;   // could not be read, and said so
  refer(place, key, names[0]);
  if (names[1] != names[0]) refer(place, key, names[1]);
}

namespace {

void check_support(const Problem& problem, SupportTable& s, Mistakes& mistakes) {
  for (const auto& [key, words] : {std::pair("directions", &s.directions), {"turns", &s.turns}}) {
    if (!*words) continue;
    const std::string& d = **words;
    if (d.empty() || std::set<char>(d.begin(), d.end()).size() != d.size() || d.find_first_not_of("xyz") != std::string::npos)
      return mistakes.add(s.place, key, "must be one, two or three of the letters x, y and z, is " + in_quotes(d));
  }
  const std::string d = s.directions.value_or(s.turns ? "" : "xyz");
  const std::set<char> letters(d.begin(), d.end());
  if (s.rotation && (s.directions || s.turns) && s.turns.value_or("").size() != 3)
    mistakes.add(s.place, "rotation", "needs all turns held; write turns = \"xyz\"");
  for (int c = 0; c < 3; ++c)
    if (s.displacement[c] != 0 && !letters.count("xyz"[c]))
      mistakes.add(s.place, "displacement", fmt::format("moves along {}, which is not among the directions \"{}\"; "
                                                        "give 0 there or hold that direction", "xyz"[c], d));
  for (int c = 0; c < 3; ++c)
    if (s.velocity[c] != 0 && !letters.count("xyz"[c]))
      mistakes.add(s.place, "velocity", fmt::format("moves along {}, which is not among the directions \"{}\"; "
                                                    "give 0 there or hold that direction", "xyz"[c], d));
  if (s.velocity.isZero(0)) return;
  if (problem.study != StudyType::dynamics)
    mistakes.add(s.place, "velocity", "belongs to dynamics, study.type = \"dynamics\"; elsewhere give a displacement");
  else if (problem.dynamics.relax)
    mistakes.add(s.place, "velocity", "does not go with dynamics.relax, which ends in an equilibrium; leave one of them out");
}

}  // namespace

namespace {

void check_solving(Problem& problem, Mistakes& mistakes) {
  SolverTable& s = problem.solver;
  const bool newton = s.by_newton();
  if (!newton && problem.study == StudyType::modes)
    mistakes.add(s.place, "method", "must be \"auto\" or \"newton\" in a study of modes, is " + in_quotes(s.method));
  if (!newton && problem.study == StudyType::path) {
    const auto by_newton = [&](TablePlace& place, const char* key, const char* what) {
      mistakes.add(place, key, fmt::format("{} follows stable and unstable equilibria, which {} does not; use solver.method = "
                                           "\"newton\"", what, in_quotes(s.method)));
    };
    if (problem.path.method == PathMethod::arc_length) by_newton(problem.path.place, "method", "arc length");
    else if (problem.path.when_unstable == WhenUnstable::follow) by_newton(problem.path.place, "when_unstable", "\"follow\"");
    if (problem.path.branches > 0) by_newton(problem.path.place, "branches", "branch switching");
    if (problem.path.deflate > 0) by_newton(problem.path.place, "deflate", "deflation");
    for (StageTable& t : problem.stages)
      if (t.method == PathMethod::arc_length) by_newton(t.place, "method", "arc length");
  }
  if (problem.study != StudyType::dynamics) return;
  DynamicsTable& d = problem.dynamics;
  if (d.place.broken) return;
  if (!d.relax && !d.timestep)
    mistakes.add(d.place, "timestep", "is missing; it must be a positive number (`elamin check` tells the largest stable one for any)");
  if (d.relax && d.timestep) mistakes.add(d.place, "timestep", "is of no use with relax = true, which chooses its own");
  if (!d.relax && d.record)
    for (const int step : *d.record)
      if (step > d.steps) {
        mistakes.add(d.place, "record", fmt::format("step {} lies behind the last one, {}", step, d.steps));
        break;
      }
  if (d.relax && d.record) mistakes.add(d.place, "record", "is of no use with relax = true, whose way to equilibrium is no motion");
}

}  // namespace

void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes) {
  Names names(problem, other_names, mistakes);
  check_structures(problem, names, mistakes);
  check_bodies(problem, names, mistakes);
  check_groups(problem, names, mistakes);
  for (SupportTable& s : problem.supports) {
    names.refer(s.place, "group", s.group);
    check_support(problem, s, mistakes);
  }
  check_loads(problem, names, mistakes);
  for (ViscosityTable& v : problem.viscosity) names.refer(v.place, "group", v.group);
  for (VelocityTable& v : problem.velocities) {
    names.refer(v.place, "group", v.group);
    if (!v.velocity && !v.spin && !v.place.broken)
      mistakes.add(v.place, "velocity", "is missing; it must be a list of three numbers [x, y, z], or give spin");
    else if (!problem.in_time())
      mistakes.add(v.place, v.velocity || !v.spin ? "velocity" : "spin", "belongs to dynamics, study.type = \"dynamics\" without relax");
  }
  for (RemoveTable& r : problem.removals) names.refer(r.place, "group", r.group);
  check_staged_structure(problem, mistakes);
  check_path(problem, mistakes);
  check_solving(problem, mistakes);
  check_interactions(problem, names, mistakes);
  check_rounded(problem, names, mistakes);
  check_results(problem, names, mistakes);
}

}  // namespace elamin
