#include "problem/build_conditions.hpp"

#include "problem/build_structures.hpp"
#include "problem/check_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    const double here = a.displacement[c], there = b.displacement[c];
    if (here == there && (here == 0 || a.constant == b.constant)) return;
    if (!told_.insert({table, earlier}).second) return;
    const std::string what = here != there ? fmt::format("{} here, {} there", here, there)
                                           : fmt::format("{} here, {} there", a.constant ? "constant" : "scaled",
                                                         b.constant ? "constant" : "scaled");
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

/// Every structure that has a particle without mass among these is told once. Particles and structures both ascend.
void need_density(const Problem& problem, const Model& model, const std::vector<int>& particles, const TablePlace& by,
                  std::set<std::string>& told, Mistakes& mistakes) {
  auto s = model.structures.begin();
  for (const int i : particles) {
    if (model.mass(i) > 0) continue;
    while (i >= s->first + s->count) ++s;
    if (!told.insert(s->name).second) continue;
    if (s->kind == "lammps")
      mistakes.add(problem.lammps->place, "data",
                   fmt::format("particle {} has no mass, which {} needs", model.id[i], named(by)));
    else
      mistakes.add(place_of(problem, *s), "density",
                   fmt::format("is missing; it must be a positive number, {} needs it", named(by)));
  }
}

}  // namespace

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
    Support s{table.group, *particles, {false, false, false}, table.displacement, table.constant};
    for (const char letter : table.directions) s.held[letter - 'x'] = true;
    stay_in_plane(problem, model, table.place, "displacement", s.displacement, mistakes);
    holders.hold(t, s);
    model.supports.push_back(std::move(s));
  }
  return whole;
}

void add_loads(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  for (const LoadTable& table : problem.loads) {
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    const Vec3 force = table.force ? *table.force : *table.total_force / static_cast<double>(particles->size());
    stay_in_plane(problem, model, table.place, table.force ? "force" : "total_force",
                  table.force ? force : *table.total_force, mistakes);
    model.loads.push_back({table.group, *particles, force, table.constant});
  }
  std::set<std::string> told;
  for (const GravityTable& table : problem.gravity) {
    const std::vector<int>* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    if (!particles) continue;
    stay_in_plane(problem, model, table.place, "acceleration", table.acceleration, mistakes);
    need_density(problem, model, *particles, table.place, told, mistakes);
    model.gravity.push_back({table.group, *particles, table.acceleration, table.constant});
  }
  for (const ViscosityTable& table : problem.viscosity)
    if (const auto* particles = table.place.broken ? nullptr : groups.find(table.place, "group", table.group))
      model.viscosity.push_back({*particles, table.coefficient});
}

}  // namespace elamin
