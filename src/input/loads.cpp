#include "core/find.hpp"
#include "core/suggest.hpp"
#include "energy/changes.hpp"
#include "input/names.hpp"
#include "input/parts.hpp"
#include "input/conditions.hpp"
#include "model/entities.hpp"
#include "model/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace elamin {

namespace {

template <class Table> void describe_scaling(Keys& keys, Table& t) {
  keys.may("constant", t.constant, "in full from the start, not scaled by the load factor");
  keys.may("from_stage", t.from_stage, "the stage it is in force from; by default from the start");
}

}  // namespace

void describe(Keys& keys, LoadTable& t) {
  keys.about("A dead load: forces that keep their direction.");
  keys.may_name("name", t.name, "for path.parameter, stages and --set");
  keys.must("group", t.group, "what it acts on");
  keys.may("force", t.force, "on every particle and body [force]");
  keys.may("total_force", t.total_force, "shared by all of them equally [force]");
  keys.may("radial", t.radial, "on every particle, away from an axis [force]");
  keys.may("center", t.center, "a point of that axis; by default the mean of the group");
  keys.may("axis", t.axis, "its direction; by default the normal of the plane");
  keys.may("point", t.point, "of bodies: where the force acts, in their frame");
  keys.may("torque", t.torque, "of bodies, besides [force·length]");
  describe_scaling(keys, t);
  keys.at_most_one({"force", "total_force", "radial"});
  keys.one_at_least({"force", "total_force", "radial", "torque"},
                    "give one of force, total_force and radial, lists of three numbers [x, y, z] but a number for radial, or on bodies torque");
  keys.with({"point"}, {"force", "total_force"}, "which act there");
  keys.with({"center", "axis"}, {"radial"}, "the force away from an axis");
}

void describe(Keys& keys, GravityTable& t) {
  keys.about("Weight.");
  keys.may_name("name", t.name, "for path.parameter, stages and --set");
  keys.may("group", t.group, "what it acts on");
  keys.must("acceleration", t.acceleration, "[length/time²]");
  describe_scaling(keys, t);
}

void describe(Keys& keys, PressureTable& t) {
  keys.about("A pressure that stays normal to what it acts on: from outside on a [[loop]], in its plane; or on a [[sheet]] whose rim is held, from the "
             "side of its normal, on a cylinder from outside.");
  keys.may_name("name", t.name, "for path.parameter, stages and --set");
  keys.may("loop", t.loop, "the name of the loop");
  keys.may("sheet", t.sheet, "or of the sheet; each particle of its rim must be held in all directions");
  keys.must("pressure", t.pressure, "[force/length], on a sheet [force/length²]");
  keys.at_most_one({"loop", "sheet"});
  keys.one_at_least({"loop", "sheet"}, "give the name of a [[loop]] or of a [[sheet]]");
  describe_scaling(keys, t);
}

void describe(Keys& keys, ChangeTable& t) {
  keys.about("Growth and stiffening of what is between the particles of a group: relative changes at load factor 1.");
  keys.may_name("name", t.name, "for path.parameter, stages and --set");
  keys.must("group", t.group, "where");
  keys.may("rest_length", t.rest_length, "of the bonds");
  keys.may("bond_stiffness", t.bond_stiffness, "of the bonds");
  keys.may("angle_stiffness", t.angle_stiffness, "of the angles");
  describe_scaling(keys, t);
  keys.one_at_least({"rest_length", "bond_stiffness", "angle_stiffness"}, "give one or more, each the relative change at load factor 1");
}

namespace {

void check_load(const Problem& problem, LoadTable& l, Mistakes& mistakes) {
  if (!l.place.written("radial")) return;
  if (l.axis) {
    check_direction(l.place, "axis", *l.axis, mistakes);
  } else if (problem.plane.empty() && !l.place.written("axis")) {
    mistakes.add(l.place, "axis", "is missing; it must be a list of three numbers [x, y, z], as the problem has no plane");
  }
}

void check_pressure(const Problem& problem, PressureTable& p, Mistakes& mistakes) {
  if (p.loop) must_be_one(problem.loops, "loop", p.place, "loop", *p.loop, mistakes);
  if (p.sheet) must_be_one(problem.sheets, "sheet", p.place, "sheet", *p.sheet, mistakes);
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
  std::set<int> chosen;
  for (const std::string& word : problem.path.parameter) {
    const int found = find_condition(conditions, word);
    if (found < 0)
      mistakes.add(problem.path.place, "parameter", in_quotes(word) + " names no table that a load factor scales; " + there_are(labels_of(conditions), word));
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
  for (ChangeTable& c : problem.changes) names.refer(c.place, "group", c.group);
  check_names(problem, mistakes);
  check_parameter(problem, mistakes);
}

namespace {

/// Every structure that has a particle without mass among these, which `needed` names, is told once. Particles and structures both ascend.
void need_density(const Problem& problem, const Model& model, const std::vector<int>& particles, const std::string& needed,
                  std::set<std::string>& told, Mistakes& mistakes) {
  auto s = model.structures.begin();
  for (const int i : particles) {
    if (model.mass(i) > 0) continue;
    while (i >= s->first + s->count) ++s;
    if (!told.insert(s->name).second) continue;
    if (s->kind == "lammps")
      mistakes.add(problem.lammps->place, "data", fmt::format("particle {} has no mass, which {} needs", model.id[i], needed));
    else
      mistakes.add(place_of(problem, *s), "density", fmt::format("is missing; it must be a positive number, {} needs it", needed));
  }
}

/// Every body without mass among these is told, at its table, once.
void need_mass(const Problem& problem, const Model& model, const std::vector<int>& bodies, const std::string& needed,
               std::set<std::string>& told, Mistakes& mistakes) {
  for (const int b : bodies) {
    if (model.bodies[b].mass > 0) continue;
    const auto s = std::find_if(model.structures.begin(), model.structures.end(),
                                [&](const Structure& t) { return b >= t.first_body && b < t.first_body + t.bodies; });
    if (s == model.structures.end() || !told.insert(s->name).second) continue;
    mistakes.add(place_of(problem, *s), s->kind == "lammps" ? "bodies" : "mass",
                 fmt::format("is missing; it must be a positive number, or give density: {} needs it", needed));
  }
}

Vec3 unit(const Vec3& v) { return (v / v.cwiseAbs().maxCoeff()).normalized(); }

/// |f| away from the axis through the centre, of each particle where it is built: 3 × particles.
Field radial_forces(const Problem& problem, const Model& model, const LoadTable& table, const std::vector<int>& particles,
                    Mistakes& mistakes) {
  ExactVector sum;
  for (const int i : particles) sum = sum + model.start.at(i);
  const double count = static_cast<double>(particles.size());
  const Vec3 center = table.center.value_or(Vec3((sum.hi + sum.lo) / count));
  const Vec3 normal = model.plane_normal ? Vec3(Vec3::Unit(*model.plane_normal)) : Vec3(Vec3::Zero());
  const Vec3 axis = table.axis ? unit(*table.axis) : normal;
  Field forces = Field::Zero(3, static_cast<Eigen::Index>(particles.size()));
  if (model.plane_normal && axis.cross(normal).norm() > 1e-12)
    mistakes.add(table.place, "axis", fmt::format("is not normal to the plane \"{}\"; leave it out", problem.plane));
  const double extent = model.start.position.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < particles.size(); ++k) {
    Vec3 arm = (model.start.at(particles[k]) - ExactVector{center, Vec3::Zero()}).hi;
    arm -= axis.dot(arm) * axis;
    if (model.plane_normal) arm[*model.plane_normal] = 0;
    if (arm.norm() <= 1e-12 * extent) {
      mistakes.add(table.place, "radial", fmt::format("has no direction at {}, which lies on the axis; leave it "
                                                      "out of the group, or move the center", called(model, particles[k])));
      return forces;
    }
    forces.col(static_cast<Eigen::Index>(k)) = *table.radial * arm.normalized();
  }
  return forces;
}

/// Triangles of a sheet, the forces on its rim, and whether all of that is held; else it is told who is not.
void press_sheet(const PressureTable& table, const SheetTable& sheet, const Structure& s, Model& model, const Scaling& scaling, Mistakes& mistakes) {
  const bool round = sheet.shape == SheetShape::cylinder;
  Pressure p{*table.sheet, {}, unit(sheet.normal), table.pressure, scaling, lattice_triangles(model, s, sheet.center, unit(sheet.normal), round),
             sheet.center, {}};
  p.particles.resize(s.count);
  std::iota(p.particles.begin(), p.particles.end(), s.first);
  p.rim = Field::Zero(3, s.count);
  std::vector<bool> held(model.particles());
  for (const Support& support : model.supports)
    for (const int i : support.particles) held[i] = held[i] || (support.held[0] && support.held[1] && support.held[2]);
  for (const auto& [i, j] : rim_edges(p.triangles)) {
    const Vec3 force = (model.start.position.col(i) - p.tip).cross(Vec3(model.start.position.col(j) - model.start.position.col(i))) / -6;
    p.rim.col(i - s.first) += force, p.rim.col(j - s.first) += force;
    if (held[i]) continue;
    mistakes.add(table.place, "sheet", fmt::format("the rim of \"{}\" must be held in all directions, and {} is not: a pressure on an edge that moves "
                                                   "has no energy", *table.sheet, called(model, i)));
    return;
  }
  if (p.triangles.empty()) return mistakes.add(table.place, "sheet", in_quotes(*table.sheet) + " has no triangles to press on");
  model.pressures.push_back(std::move(p));
}

void add_pressures(const Problem& problem, Model& model, Mistakes& mistakes) {
  for (std::size_t t = 0; t < problem.pressures.size(); ++t) {
    const PressureTable& table = problem.pressures[t];
    const Scaling scaling = scaling_of(problem, condition_of("pressure", problem.pressures, t));
    if (table.place.broken) continue;
    const LoopTable* loop = table.loop ? find_named(problem.loops, *table.loop) : nullptr;
    const SheetTable* sheet = table.sheet ? find_named(problem.sheets, *table.sheet) : nullptr;
    const Structure* s = loop || sheet ? find_named(model.structures, loop ? loop->name : sheet->name) : nullptr;
    if (!s) continue;
    if (sheet) {
      press_sheet(table, *sheet, *s, model, scaling, mistakes);
    } else {
      Pressure p{*table.loop, {}, unit(loop->normal), table.pressure, scaling};
      for (int i = 0; i < s->count; ++i) p.particles.push_back(s->first + i);
      model.pressures.push_back(std::move(p));
    }
  }
}

void add_changes(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  std::vector<const ChangeTable*> tables;         // of the model's changes
  for (std::size_t t = 0; t < problem.changes.size(); ++t) {
    const ChangeTable& table = problem.changes[t];
    const Members* members = groups.find(table.place, "group", table.group);
    if (!members) continue;
    model.changes.push_back({table.group, members->particles, table.rest_length.value_or(0), table.bond_stiffness.value_or(0),
                             table.angle_stiffness.value_or(0),
                             scaling_of(problem, condition_of("change", problem.changes, t))});
    tables.push_back(&table);
  }
  // A change must find something to act on, and leave lengths and stiffnesses positive.
  std::set<std::pair<int, std::string>> told;
  using Parts = std::initializer_list<std::pair<const char*, double Change::*>>;
  const auto look = [&](const Kinds& kinds, const char* what, Parts parts) {
    for (const auto& [key, part] : parts) {
      for (std::size_t c = 0; c < tables.size(); ++c) {
        const auto acts = [&](const std::vector<int>& on) { return contains(on, static_cast<int>(c)); };
        if (model.changes[c].*part != 0 && std::none_of(kinds.changes.begin(), kinds.changes.end(), acts))
          mistakes.add(tables[c]->place, key, fmt::format("changes nothing: no {} has all its particles in \"{}\"", what,
                                                          model.changes[c].group));
      }
      for (std::vector<int> on : kinds.changes) {
        std::erase_if(on, [&, factor = part](int c) { return model.changes[c].*factor == 0; });
        for (const double lambda : load_factors(problem)) {
          const double factor = change_factor(model, on, part, lambda).value();
          if (factor > 0 || !told.insert({on.back(), key}).second) continue;
          mistakes.add(tables[on.back()]->place, key,
                       fmt::format("leaves {} of what there is at load factor {}{}; more than nothing must remain", factor,
                                   lambda, on.size() > 1 ? ", with the other changes there" : ""));
        }
      }
    }
  };
  if (tables.empty()) return;
  look(bond_kinds(model), "bond", {{"rest_length", &Change::rest_length}, {"bond_stiffness", &Change::bond_stiffness}});
  look(angle_kinds(model), "angle", {{"angle_stiffness", &Change::angle_stiffness}});
}

}  // namespace

void turn_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v,
                   Mistakes& mistakes) {
  for (int c = 0; model.plane_normal && c < 3; ++c)
    if (c != *model.plane_normal && v[c] != 0)
      return mistakes.add(place, key, fmt::format("turns out of the plane \"{}\": its {} component is {}; it must be 0",
                                                  problem.plane, "xyz"[c], v[c]));
}

void stay_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v, Mistakes& mistakes) {
  if (!model.plane_normal || v[*model.plane_normal] == 0) return;
  const char normal = "xyz"[*model.plane_normal];
  mistakes.add(place, key,
               fmt::format("leads out of the plane \"{}\": its {} component is {}; it must be 0", problem.plane, normal,
                           v[*model.plane_normal]));
}

void need_masses(const Problem& problem, const Model& model, Mistakes& mistakes) {
  std::vector<int> all(model.particles());
  std::iota(all.begin(), all.end(), 0);
  std::set<std::string> told;
  need_density(problem, model, all, "dynamics", told, mistakes);
  all.resize(model.bodies.size());
  std::iota(all.begin(), all.end(), 0);
  need_mass(problem, model, all, "dynamics", told, mistakes);
}

void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  for (std::size_t t = 0; t < problem.loads.size(); ++t) {
    const LoadTable& table = problem.loads[t];
    const Members* members = groups.find(table.place, "group", table.group);
    if (!members) continue;
    Load load{table.group, members->particles, Vec3::Zero(), scaling_of(problem, condition_of("load", problem.loads, t))};
    load.bodies = members->bodies;
    for (const char* key : {"point", "torque"})
      if (table.place.keys.count(key) && load.bodies.empty())
        mistakes.add(table.place, key, fmt::format("is of bodies, and \"{}\" has none; leave it out", table.group));
    load.point = table.point.value_or(load.point), load.torque = table.torque.value_or(load.torque);
    if (table.radial) {
      if (!load.bodies.empty())
        mistakes.add(table.place, "radial", fmt::format("is of particles, and \"{}\" has bodies; give force", table.group));
      else
        load.own = radial_forces(problem, model, table, load.particles, mistakes);
    } else if (table.force || table.total_force) {
      load.force = table.force ? *table.force : *table.total_force / members->count();
      stay_in_plane(problem, model, table.place, table.force ? "force" : "total_force",
                    table.force ? *table.force : *table.total_force, mistakes);
    }
    turn_in_plane(problem, model, table.place, "torque", load.torque, mistakes);
    model.loads.push_back(std::move(load));
  }
  std::set<std::string> told;
  for (std::size_t t = 0; t < problem.gravity.size(); ++t) {
    const GravityTable& table = problem.gravity[t];
    const Members* members = groups.find(table.place, "group", table.group);
    if (!members) continue;
    stay_in_plane(problem, model, table.place, "acceleration", table.acceleration, mistakes);
    need_density(problem, model, members->particles, named(table.place), told, mistakes);
    need_mass(problem, model, members->bodies, named(table.place), told, mistakes);
    model.gravity.push_back({table.group, members->particles, table.acceleration,
                             scaling_of(problem, condition_of("gravity", problem.gravity, t)), members->bodies});
  }
  add_pressures(problem, model, mistakes);
  add_changes(problem, groups, model, mistakes);
}

}  // namespace elamin
