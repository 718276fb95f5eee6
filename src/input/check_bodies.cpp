// Rigid bodies: their tables, and what the laws of rounded bodies ask for.
#include "input/check_parts.hpp"
#include "input/check_region.hpp"
#include "lammps/body.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {
namespace {

void check_turn(std::optional<TurnTable>& turn, Mistakes& mistakes) {
  if (turn) check_direction(turn->place, "axis", turn->axis, mistakes);
}

void check_mesh(BodyTable& b, Mistakes& mistakes) {
  if (b.vertices.size() > 2 && b.faces.empty() && !b.place.keys.count("faces"))
    mistakes.add(b.place, "faces", "is missing; it must be a list of faces, each a list of the indices of its vertices from 1");
  if (!b.edges) return;
  for (const std::vector<int>& e : *b.edges)
    if (e.size() != 2) return mistakes.add(b.place, "edges", fmt::format("must be pairs of vertices; one has {}", e.size()));
}

void check_body(BodyTable& b, Mistakes& mistakes) {
  check_turn(b.rotation, mistakes);
  if (b.rotation && b.rotation->place.broken) b.place.broken = true;
  if (b.place.broken) return;
  if (b.shape == BodyShape::mesh) check_mesh(b, mistakes);
  if (b.mass && b.density) mistakes.add(b.place, "density", "mass is there too; give one of them");
  if (!b.inertia) return;
  const std::vector<double>& i = *b.inertia;
  if (!b.mass) mistakes.add(b.place, "inertia", "needs mass; of a density it follows");
  if (i.size() != 6)
    return mistakes.add(b.place, "inertia", fmt::format("must be six numbers [ixx, iyy, izz, ixy, ixz, iyz], is a list of {}", i.size()));
  Mat3 inertia;
  inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  if (const std::string wrong = wrong_inertia(inertia); !wrong.empty()) mistakes.add(b.place, "inertia", wrong);
}

/// LAMMPS's rules are forces without an energy.
void check_potential(const Problem& problem, TablePlace& place, const char* why, Mistakes& mistakes) {
  const bool minimises = problem.study == StudyType::equilibrium || problem.study == StudyType::path ||
                         problem.study == StudyType::modes || (problem.study == StudyType::dynamics && problem.dynamics.relax);
  if (minimises) mistakes.add(place, "formulation", why);
}

void check_rounded(const Problem& problem, ContactTable& c, Mistakes& mistakes) {
  const RoundedKeys& r = c.rounded;
  if (r.k_na > 0 && !c.cutoff)
    mistakes.add(c.place, "cutoff", "is missing; it must be a positive number, within which k_na attracts");
  if (r.formulation == RoundedFormulation::lammps)
    return check_potential(problem, c.place, "\"lammps\" has no potential: its forces are no gradient of an energy; take formulation = "
                                             "\"multi\" or \"closest\"", mistakes);
  if (r.mu > 0 && r.slip == 0)
    mistakes.add(c.place, "slip", "is missing; it must be a positive number, the damping that takes the place of friction mu at small "
                                  "sliding velocities");
}

void check_wall(const Problem& problem, WallTable& w, Mistakes& mistakes) {
  if (!w.k_n) {
    const std::pair<const char*, bool> said[]{{"k_na", w.k_na > 0}, {"cutoff", w.cutoff > 0}, {"c_n", w.c_n > 0}, {"c_t", w.c_t.has_value()},
                                              {"formulation", w.lammps}};
    for (const auto& [key, there] : said)
      if (there) mistakes.add(w.place, key, "is of bodies, and so needs k_n");
    return;
  }
  if (w.k_na > 0 && !(w.cutoff > 0))
    mistakes.add(w.place, "cutoff", "is missing; it must be a positive number, within which k_na attracts");
  if (!w.lammps) return;
  check_potential(problem, w.place, "\"lammps\" has no potential: its forces have no energy; take formulation = \"potential\"", mistakes);
  if (w.k_na > 0) mistakes.add(w.place, "k_na", "does not go with formulation = \"lammps\", whose walls do not attract; leave it out");
  const Region& r = w.region;
  const bool across = r.shape == Shape::plane && (r.normal.array() != 0).count() == 1;
  if (!across && !(r.shape == Shape::block && w.inside))
    mistakes.add(w.place, "shape", "with formulation = \"lammps\" must be a plane across an axis, or a block, inside");
}

}  // namespace

void check_bodies(Problem& problem, Names& names, Mistakes& mistakes) {
  for (BodyTable& b : problem.bodies) {
    names.add(b.place, b.name);
    check_body(b, mistakes);
  }
}

void check_rounded(Problem& problem, Names& names, Mistakes& mistakes) {
  for (GlueTable& g : problem.glue) {
    names.refer(g.place, "group", g.group);
    names.refer(g.place, "body", g.body);
  }
  for (SupportTable& s : problem.supports) {
    check_turn(s.rotation, mistakes);
    s.place.broken = s.place.broken || (s.rotation && s.rotation->place.broken);
  }
  const ContactTable* first = nullptr;
  for (ContactTable& c : problem.contacts) {
    if (c.place.broken || c.law != "rounded") continue;
    check_rounded(problem, c, mistakes);
    if (!first) first = &c;
    else if (c.cutoff.value_or(0) != first->cutoff.value_or(0))
      mistakes.add(c.place, "cutoff", fmt::format("is {}, and that of {} is {}; all tables with law \"rounded\" have one cutoff",
                                                  c.cutoff.value_or(0), named(first->place), first->cutoff.value_or(0)));
  }
  for (WallTable& w : problem.walls)
    if (!w.place.broken) check_wall(problem, w, mistakes);
}

}  // namespace elamin
