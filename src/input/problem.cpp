#include "input/problem.hpp"

namespace elamin {
namespace {

constexpr std::array plane_words{"xy", "xz", "yz"};

}  // namespace

void describe(Keys& keys, ProblemFile& file) {
  Problem& p = file.problem;
  keys.about("What stands before the first table.");
  keys.may("title", p.title, "of the problem");
  keys.word("plane", p.plane, plane_words, "that every particle stays in; by default none");
  keys.table("constants", p.constants);   // before all that may use them
  keys.table("lammps", p.lammps);
  for_structures(p, [&](const char* kind, auto& tables) { keys.tables(kind, tables); });
  keys.tables("group", p.groups);
  keys.tables("connect", p.connections);
  keys.tables("bonds", p.bonds);
  keys.tables("angles", p.angles);
  keys.tables("remove", p.removals);
  keys.tables("glue", p.glue);
  keys.table("imperfection", p.imperfection);
  keys.tables("support", p.supports);
  keys.tables("load", p.loads);
  keys.tables("gravity", p.gravity);
  keys.tables("pressure", p.pressures);
  keys.tables("change", p.changes);
  keys.tables("contact", p.contacts);
  keys.tables("wall", p.walls);
  keys.tables("viscosity", p.viscosity);
  keys.tables("velocity", p.velocities);
  StudyTable study{p.study_place, p.study};
  keys.table("study", study);
  p.study = study.type, p.study_place = study.place;
  keys.table("path", p.path);
  keys.table("curve", p.curve);
  keys.table("refine", p.refine);
  keys.table("landscape", p.landscape);
  keys.table("modes", p.modes);
  keys.table("solver", p.solver);
  keys.table("dynamics", p.dynamics);
  keys.tables("stage", p.stages);
  keys.tables("observe", p.observe);
  keys.tables("event", p.events);
  keys.tables("expect", p.expect);
  keys.tables("sweep", file.sweeps);
}

}  // namespace elamin
