#include "input/check.hpp"

#include "input/parts.hpp"
#include "input/staged_structure.hpp"

namespace elamin {

void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes) {
  if (problem.lammps) check_lammps(*problem.lammps, mistakes);
  Names names(problem, other_names, mistakes);
  check_structures(problem, names, mistakes);
  check_bodies(problem, names, mistakes);
  check_groups(problem, names, mistakes);
  for (GlueTable& g : problem.glue) names.refer(g.place, "group", g.group), names.refer(g.place, "body", g.body);
  if (problem.imperfection) {
    names.refer(problem.imperfection->place, "group", problem.imperfection->group);
    check(*problem.imperfection, mistakes);
  }
  check_supports(problem, names, mistakes);
  check_loads(problem, names, mistakes);
  check_motion(problem, names, mistakes);
  check_connections(problem, names, mistakes);
  check_staged_structure(problem, mistakes);
  check_path(problem, mistakes);
  check_curve(problem, mistakes);
  check_refine(problem, mistakes);
  check_landscape(problem, mistakes);
  check_solver(problem, mistakes);
  check_walls(problem, names, mistakes);
  check_contacts(problem, names, mistakes);
  check_results(problem, names, mistakes);
}

}  // namespace elamin
