#include "input/check.hpp"

#include "input/check_parts.hpp"
#include "input/staged_structure.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

namespace elamin {

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
  for (const auto& [key, given] : {std::pair("record", d.record.has_value()), {"film", !d.film.empty()}})
    if (d.relax && given) mistakes.add(d.place, key, "is of no use with relax = true, whose way to equilibrium is no motion");
}

}  // namespace

void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes) {
  if (problem.lammps) check_lammps(*problem.lammps, mistakes);
  Names names(problem, other_names, mistakes);
  check_structures(problem, names, mistakes);
  check_bodies(problem, names, mistakes);
  check_groups(problem, names, mistakes);
  if (problem.imperfection) {
    names.refer(problem.imperfection->place, "group", problem.imperfection->group);
    check(*problem.imperfection, mistakes);
  }
  for (SupportTable& s : problem.supports) {
    names.refer(s.place, "group", s.group);
    check_support(problem, s, mistakes);
  }
  check_loads(problem, names, mistakes);
  for (ViscosityTable& v : problem.viscosity) names.refer(v.place, "group", v.group);
  for (VelocityTable& v : problem.velocities) {
    names.refer(v.place, "group", v.group);
    if (!v.velocity && !v.angular_velocity && !v.place.broken)
      mistakes.add(v.place, "velocity", "is missing; it must be a list of three numbers [x, y, z], or give angular_velocity");
    else if (!problem.in_time())
      mistakes.add(v.place, v.velocity || !v.angular_velocity ? "velocity" : "angular_velocity", "belongs to dynamics, study.type = \"dynamics\" without relax");
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
