#include "input/staged_structure.hpp"

#include "core/find.hpp"
#include "model/connect.hpp"
#include "model/entities.hpp"
#include "input/names.hpp"
#include "input/parts.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace elamin {
namespace {

// Of every particle, then of every body.
std::vector<bool> members_of(const Model& model, const std::string& name) {
  std::vector<bool> of(entities(model));
  if (const Group* group = find_named(model.groups, name)) {
    for (const int p : group->particles) of[p] = true;
    for (const int b : group->bodies) of[model.particles() + b] = true;
  }
  return of;
}

template <class Element> bool any_of(const Element& element, const std::vector<bool>& marked) {
  return std::any_of(element.particles.begin(), element.particles.end(), [&](int p) { return marked[p]; });
}
template <class Element> bool all_of(const Element& element, const std::vector<bool>& marked) {
  return std::all_of(element.particles.begin(), element.particles.end(), [&](int p) { return marked[p]; });
}

void remove_glue(const RemoveTable& r, Model& model) {
  const std::vector<bool> of = members_of(model, r.group);
  std::erase_if(model.angles, [&](const Angle& a) {
    const bool over_bond = (of[a.particles[0]] && of[a.particles[1]]) || (of[a.particles[1]] && of[a.particles[2]]);
    return r.what == RemoveTable::What::angles ? all_of(a, of) : over_bond;
  });
  if (r.what == RemoveTable::What::bonds) std::erase_if(model.bonds, [&](const Bond& b) { return all_of(b, of); });
}

void hold_absent(const std::vector<bool>& absent, Model& model, const State& now) {
  const auto gone = [&](int p) { return absent[p]; };
  const auto gone_body = [&](int b) { return absent[model.particles() + b]; };
  std::erase_if(model.bonds, [&](const Bond& b) { return any_of(b, absent); });
  std::erase_if(model.angles, [&](const Angle& a) { return any_of(a, absent); });
  for (PairContact& c : model.contacts)
    for (auto& side : c.particles) std::erase_if(side, gone);
  std::erase_if(model.contacts, [](const PairContact& c) { return c.particles[0].empty() || c.particles[1].empty(); });
  for (RoundedPair& r : model.rounded)
    for (int side = 0; side < 2; ++side) std::erase_if(r.particles[side], gone), std::erase_if(r.bodies[side], gone_body);
  std::erase_if(model.rounded, [](const RoundedPair& r) {
    return (r.particles[0].empty() && r.bodies[0].empty()) || (r.particles[1].empty() && r.bodies[1].empty());
  });
  for (Wall& w : model.walls) std::erase_if(w.particles, gone), std::erase_if(w.bodies, gone_body);
  for (Gravity& g : model.gravity) std::erase_if(g.particles, gone), std::erase_if(g.bodies, gone_body);
  for (Change& c : model.changes) std::erase_if(c.particles, gone);
  std::erase_if(model.pressures, [&](const Pressure& p) { return any_of(p, absent); });
  for (Load& l : model.loads) {
    const Load whole = l;
    std::vector<Eigen::Index> kept;
    l.particles.clear();
    for (std::size_t k = 0; k < whole.particles.size(); ++k)
      if (!absent[whole.particles[k]]) l.particles.push_back(whole.particles[k]), kept.push_back(static_cast<Eigen::Index>(k));
    if (whole.own.size()) l.own = whole.own(Eigen::all, kept);
    std::erase_if(l.bodies, gone_body);
  }
  for (Support& s : model.supports) {
    const Support whole = s;
    s.particles.clear(), s.reference.clear();
    for (std::size_t k = 0; k < whole.particles.size(); ++k) {
      if (absent[whole.particles[k]]) continue;
      s.particles.push_back(whole.particles[k]);
      if (!whole.reference.empty()) s.reference.push_back(whole.reference[k]);
    }
    s.bodies.clear(), s.body_reference.clear();
    for (std::size_t k = 0; k < whole.bodies.size(); ++k) {
      if (gone_body(whole.bodies[k])) continue;
      s.bodies.push_back(whole.bodies[k]);
      if (!whole.body_reference.empty()) s.body_reference.push_back(whole.body_reference[k]);
    }
  }
  Support still;
  still.scaling = Scaling(0, 0);
  still.constrained_rotations = {true, true, true};
  std::vector<bool> carried(model.particles());                  // their body is held
  for (const Glued& g : model.glued) carried[g.particle] = true;
  for (int p = 0; p < model.particles(); ++p)
    if (absent[p] && !carried[p]) still.particles.push_back(p), still.reference.push_back(now.at(p));
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (gone_body(b)) still.bodies.push_back(b), still.body_reference.push_back(now.bodies[b]);
  model.supports.push_back(std::move(still));
}

}  // namespace

int stage_number(const Problem& problem, const std::string& name) {
  for (std::size_t k = 0; k < problem.stages.size(); ++k)
    if (problem.stages[k].name == name) return static_cast<int>(k);
  return 0;
}

std::vector<bool> absent_in(const Problem& problem, int stage, const Model& model) {
  std::vector<bool> absent(entities(model));
  const auto mark = [&](const std::string& group) {
    const std::vector<bool> of = members_of(model, group);
    for (std::size_t p = 0; p < of.size(); ++p) absent[p] = absent[p] || of[p];
  };
  for_structures(problem, [&](const char*, const auto& tables) {
    for (const auto& t : tables)
      if (stage_number(problem, t.from_stage) > stage) mark(t.name);
  });
  for (const GroupTable& g : problem.groups)
    if (stage_number(problem, g.from_stage) > stage) mark(g.name);
  for (const RemoveTable& r : problem.removals)
    if (r.what == RemoveTable::What::particles && stage_number(problem, r.from_stage) <= stage) mark(r.group);
  for (const Glued& g : model.glued) absent[g.particle] = absent[model.particles() + g.body];
  return absent;
}

bool connects_before(const Problem& problem, int stage) {
  const auto any = [&](const auto& tables) {
    return std::any_of(tables.begin(), tables.end(), [&](const auto& t) {
      const int from = stage_number(problem, t.from_stage);
      return from > 0 && from <= stage;
    });
  };
  return any(problem.connections) || any(problem.bonds) || any(problem.angles);
}

std::string connect_in(const Problem& problem, int stage, Model& all, const State& now) {
  std::string none;
  if (stage == 0) return none;                           // made as the model was built
  const State built = std::exchange(all.start, now);
  const std::vector<bool> absent = absent_in(problem, stage, all);
  const auto begins = [&](const auto& t) { return stage_number(problem, t.from_stage) == stage; };
  const auto members = [&](const std::string& name, bool those_there) {
    std::vector<int> particles;
    if (const Group* group = find_named(all.groups, name))
      std::copy_if(group->particles.begin(), group->particles.end(), std::back_inserter(particles), [&](int p) { return !those_there || !absent[p]; });
    return particles;
  };
  const auto join = [&](const ConnectTable& t, const std::string& what) {
    Connection c = connection_of(t);
    c.first = members(t.between[0], true), c.second = members(t.between[1], true);
    if (connect(all, c) <= 0 && none.empty())
      none = fmt::format("{} makes no bond: no particle of \"{}\" is within {} of one of \"{}\" that it is not bonded to already", what, t.between[1],
                         t.within.value_or(0), t.between[0]);
  };
  const auto gone = [&](const auto& element) { return any_of(element, absent); };
  Mistakes told(problem.file);                           // as the model was built
  for (std::size_t k = 0; k < problem.connections.size(); ++k)
    if (begins(problem.connections[k])) join(problem.connections[k], fmt::format("connect.{}", k + 1));
  for (std::size_t k = 0; k < problem.bonds.size(); ++k) {
    const BondsTable& t = problem.bonds[k];
    if (!begins(t)) continue;
    if (t.rule) {
      join(by_rule(t), fmt::format("bonds.{}", k + 1));
      continue;
    }
    std::array<std::vector<int>, 2> sides;
    for (int side = 0; t.between && side < 2; ++side) sides[side] = members((*t.between)[side], false);
    std::vector<NewBond> bonds = listed_bonds(t, t.between ? &sides : nullptr, all, told);
    std::erase_if(bonds, gone);
    add_bonds(all, bonds);
  }
  for (const AnglesTable& t : problem.angles) {
    if (!begins(t)) continue;
    std::vector<NewAngle> angles = listed_angles(t, members(t.over.value_or(""), true), all, told);
    std::erase_if(angles, gone);
    add_angles(all, angles);
  }
  all.start = built;
  return none;
}

void leave_out(const Problem& problem, int stage, Model& model, const State& now) {
  for (const RemoveTable& r : problem.removals)
    if (r.what != RemoveTable::What::particles && stage_number(problem, r.from_stage) <= stage) remove_glue(r, model);
  const std::vector<bool> absent = absent_in(problem, stage, model);
  if (contains(absent, true)) hold_absent(absent, model, now);
}

void check_from_stage(const Problem& problem, TablePlace& place, const std::string& from, Mistakes& mistakes) {
  if (!from.empty()) must_be_one(problem.stages, "stage", place, "from_stage", from, mistakes);
}

void check_staged_structure(Problem& problem, Mistakes& mistakes) {
  const auto check = [&](TablePlace& place, const std::string& from) { check_from_stage(problem, place, from, mistakes); };
  for_structures(problem, [&](const char*, auto& tables) {
    for (auto& t : tables) check(t.place, t.from_stage);
  });
  for (GroupTable& g : problem.groups) check(g.place, g.from_stage);
  for (ConnectTable& c : problem.connections) check(c.place, c.from_stage);
  for (BondsTable& t : problem.bonds) check(t.place, t.from_stage);
  for (AnglesTable& t : problem.angles) check(t.place, t.from_stage);
  for (RemoveTable& r : problem.removals) {
    check(r.place, r.from_stage);
    if (!problem.stages.empty() && r.from_stage == problem.stages.front().name)
      mistakes.add(r.place, "from_stage", "is the first stage; what is never there is best left out");
  }
}

}  // namespace elamin
