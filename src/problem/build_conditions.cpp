#include "problem/build_conditions.hpp"

#include "energy/changes.hpp"
#include "problem/build_structures.hpp"
#include "problem/check_parts.hpp"
#include "problem/conditions.hpp"
#include "problem/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace elamin {
namespace {

/// A vector that has a component along the normal of the plane is a mistake.
void stay_in_plane(const Problem& problem, const Model& model, const TablePlace& place, const char* key, const Vec3& v,
                   Mistakes& mistakes) {
  if (!model.plane_normal || v[*model.plane_normal] == 0) return;
  const char normal = "xyz"[*model.plane_normal];
  mistakes.add(place, key,
               fmt::format("leads out of the plane \"{}\": its {} component is {}; it must be 0", problem.plane, normal,
                           v[*model.plane_normal]));
}

/// Which support holds each coordinate of each particle; two that hold one alike are fine.
class Holders {
 public:
  Holders(const Problem& problem, const Model& model, Mistakes& mistakes)
      : problem_(problem),
        model_(model),
        mistakes_(mistakes),
        holder_(3 * static_cast<std::size_t>(model.particles()), -1) {}

  void hold(int table, const Support& s) {
    for (const int i : s.particles)
      for (int c = 0; c < 3; ++c) {
        if (!s.held[c]) continue;
        int& holder = holder_[3 * static_cast<std::size_t>(i) + c];
        if (holder < 0)
          holder = table;
        else
          compare(table, holder, i, c);
      }
  }

 private:
  void compare(int table, int earlier, int particle, int c) {
    const SupportTable &a = problem_.supports[table], &b = problem_.supports[earlier];
    if (a.velocity[c] != b.velocity[c] && told_.insert({table, earlier}).second)
      return mistakes_.add(a.place, "velocity", fmt::format("moves {} of particle {} otherwise than {} ({} here, {} there); one coordinate has "
                                                            "one velocity", "xyz"[c], model_.id[particle], named(b.place),
                                                            a.velocity[c], b.velocity[c]));
    const double here = a.displacement[c], there = b.displacement[c];
    if ((here == 0 && there == 0) || told_.count({table, earlier})) return;
    const Condition one = condition_of("support", problem_.supports, table), other = condition_of("support", problem_.supports, earlier);
    if (!ever_together(problem_, one, other)) return;
    const Scaling at_a = scaling_of(problem_, condition_of("support", problem_.supports, table)),
                  at_b = scaling_of(problem_, condition_of("support", problem_.supports, earlier));
    if (here == there && at_a == at_b) return;
    told_.insert({table, earlier});
    const auto word = [](const Scaling& s) { return s.rate == 0 ? "constant" : "scaled"; };
    const std::string what = here != there ? fmt::format("{} here, {} there", here, there)
                                           : fmt::format("{} here, {} there", word(at_a), word(at_b));
    mistakes_.add(
        a.place, fmt::format("prescribes {} of particle {} otherwise than {} ({}); one coordinate has one displacement",
                             "xyz"[c], model_.id[particle], named(b.place), what));
  }

  const Problem& problem_;
  const Model& model_;
  Mistakes& mistakes_;
  std::vector<int> holder_;
  std::set<std::pair<int, int>> told_;
};

/// Every structure that has a particle without mass among these, which `needed` names, is told once. Particles and structures both ascend.
void need_density(const Problem& problem, const Model& model, const std::vector<int>& particles, const std::string& needed,
                  std::set<std::string>& told, Mistakes& mistakes) {
  auto s = model.structures.begin();
  for (const int i : particles) {
    if (model.mass(i) > 0) continue;
    while (i >= s->first + s->count) ++s;
    if (!told.insert(s->name).second) continue;
    if (s->kind == "lammps")
      mistakes.add(problem.lammps->place, "data",
                   fmt::format("particle {} has no mass, which {} needs", model.id[i], needed));
    else
      mistakes.add(place_of(problem, *s), "density",
                   fmt::format("is missing; it must be a positive number, {} needs it", needed));
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
      mistakes.add(table.place, "radial", fmt::format("has no direction at particle {}, which lies on the axis; leave it "
                                                      "out of the group, or move the center", model.id[particles[k]]));
      return forces;
    }
    forces.col(static_cast<Eigen::Index>(k)) = *table.radial * arm.normalized();
  }
  return forces;
}

void add_pressures(const Problem& problem, Model& model) {
  for (std::size_t t = 0; t < problem.pressures.size(); ++t) {
    const PressureTable& table = problem.pressures[t];
    const auto loop = std::find_if(problem.loops.begin(), problem.loops.end(),
                                   [&](const LoopTable& l) { return l.name == table.loop; });
    const auto built = std::find_if(model.structures.begin(), model.structures.end(),
                                    [&](const Structure& s) { return s.kind == "loop" && s.name == table.loop; });
    if (table.place.broken || loop == problem.loops.end() || built == model.structures.end()) continue;
    Pressure p{table.loop, {}, unit(loop->normal), table.pressure,
               scaling_of(problem, condition_of("pressure", problem.pressures, t))};
    for (int i = 0; i < built->count; ++i) p.particles.push_back(built->first + i);
    model.pressures.push_back(std::move(p));
  }
}

void add_changes(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  std::vector<const ChangeTable*> tables;         // of the model's changes
  for (std::size_t t = 0; t < problem.changes.size(); ++t) {
    const ChangeTable& table = problem.changes[t];
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    model.changes.push_back({table.group, *particles, table.rest_length.value_or(0), table.bond_stiffness.value_or(0),
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
        const auto acts = [&](const std::vector<int>& on) {
          return std::find(on.begin(), on.end(), static_cast<int>(c)) != on.end();
        };
        if (model.changes[c].*part != 0 && std::none_of(kinds.changes.begin(), kinds.changes.end(), acts))
          mistakes.add(tables[c]->place, key, fmt::format("changes nothing: no {} has all its particles in \"{}\"", what,
                                                          model.changes[c].group));
      }
      for (std::vector<int> on : kinds.changes) {
        std::erase_if(on, [&](int c) { return model.changes[c].*part == 0; });
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

void need_masses(const Problem& problem, const Model& model, Mistakes& mistakes) {
  std::vector<int> all(model.particles());
  std::iota(all.begin(), all.end(), 0);
  std::set<std::string> told;
  need_density(problem, model, all, "dynamics", told, mistakes);
}

bool add_supports(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  Holders holders(problem, model, mistakes);
  for (int t = 0; t < static_cast<int>(problem.supports.size()); ++t) {
    const SupportTable& table = problem.supports[t];
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) {
      whole = false;
      continue;
    }
    Support s{table.group, *particles, {false, false, false}, table.displacement,
              scaling_of(problem, condition_of("support", problem.supports, t))};
    for (const char letter : table.directions) s.held[letter - 'x'] = true;
    s.velocity = table.velocity;
    stay_in_plane(problem, model, table.place, "displacement", s.displacement, mistakes);
    stay_in_plane(problem, model, table.place, "velocity", s.velocity, mistakes);
    holders.hold(t, s);
    model.supports.push_back(std::move(s));
  }
  return whole;
}

void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  for (std::size_t t = 0; t < problem.loads.size(); ++t) {
    const LoadTable& table = problem.loads[t];
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    Load load{table.group, *particles, Vec3::Zero(),
              scaling_of(problem, condition_of("load", problem.loads, t))};
    if (table.radial) {
      load.own = radial_forces(problem, model, table, *particles, mistakes);
    } else {
      load.force = table.force ? *table.force : *table.total_force / static_cast<double>(particles->size());
      stay_in_plane(problem, model, table.place, table.force ? "force" : "total_force",
                    table.force ? *table.force : *table.total_force, mistakes);
    }
    model.loads.push_back(std::move(load));
  }
  std::set<std::string> told;
  for (std::size_t t = 0; t < problem.gravity.size(); ++t) {
    const GravityTable& table = problem.gravity[t];
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    stay_in_plane(problem, model, table.place, "acceleration", table.acceleration, mistakes);
    need_density(problem, model, *particles, named(table.place), told, mistakes);
    model.gravity.push_back({table.group, *particles, table.acceleration,
                             scaling_of(problem, condition_of("gravity", problem.gravity, t))});
  }
  for (const ViscosityTable& table : problem.viscosity)
    if (const auto* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group))
      model.viscosity.push_back({*particles, table.coefficient});
  for (const VelocityTable& table : problem.velocities) {
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    stay_in_plane(problem, model, table.place, "velocity", table.velocity, mistakes);
    if (model.velocity.cols() == 0) model.velocity = Field::Zero(3, model.particles());
    for (const int i : *particles) model.velocity.col(i) = table.velocity;
  }
  add_pressures(problem, model);
  add_changes(problem, groups, model, mistakes);
}

}  // namespace elamin
