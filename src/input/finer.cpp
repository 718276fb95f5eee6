#include "input/finer.hpp"

#include "core/find.hpp"
#include "core/near_pairs.hpp"
#include "input/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace elamin {
namespace {

/// A row of particles that is refined: which particle the i-th becomes. `begin`, `end`: 1 where one particle stands beyond that end.
struct Row {
  int count = 0, begin = 0, end = 0, by = 1;
  bool closed = false;
  int fine_count() const { return closed ? by * count : by * (count - 1 - begin - end) + 1 + begin + end; }
  int image(int i) const { return i < begin ? 0 : i >= count - end && !closed ? fine_count() - 1 : begin + by * (i - begin); }
  bool there(int i) const { return closed || (i >= 0 && i < count); }

  /// The particles of a set, with what lies between neighbours. `held`: it clamps the row where it ends between two neighbours, in the middle of the bond;
  /// `lost`: there is no bond with this middle.
  std::set<int> images(const std::set<int>& in, bool held, bool& lost) const {
    std::set<int> out;
    const auto has = [&](int i) { return there(i) && in.count(closed ? (i + count) % count : i) > 0; };
    const bool whole = closed && std::ssize(in) == count;
    for (const int first : in) {                                // of neighbours, up to `last`
      if (has(first - 1) && !(whole && first == 0)) continue;
      int last = first;
      while (last < first + count && has(last + 1)) ++last;
      const bool clamps = held && last > first && !whole;
      const bool below = clamps && there(first - 1) && (closed || first + 1 < count - end);
      const bool above = clamps && there(last + 1) && (closed || last - 1 >= begin);
      lost = lost || ((below || above) && by % 2 == 0);
      const int from = image(first) + (below ? (by - 1) / 2 : 0), to = above ? image(last - 1) + (by + 1) / 2 : image(last);
      for (int k = from; k <= to; ++k) out.insert(k % fine_count());
    }
    return out;
  }
};

/// The structures of a model, and what becomes of them.
class Refined {
 public:
  Refined(const Problem& problem, const Model& model, int by, Mistakes& mistakes) : model_(model) {
    int first = 0;
    for (const Structure& s : model.structures) {
      Part part{s, {}, first, s.count, 0};
      if (const BeamTable* t = find_named(problem.beams, s.name)) {
        const bool both = t->clamped == ClampedEnds::both;
        part.row = Row{s.count, both || t->clamped == ClampedEnds::from, both || t->clamped == ClampedEnds::to, by, false};
      }
      if (find_named(problem.loops, s.name)) part.row = Row{s.count, 0, 0, by, true};
      if (part.row) part.fine_count = part.row->fine_count();
      if (const SheetTable* t = find_named(problem.sheets, s.name)) {
        SheetTable fine = *t;
        part.spacing = fine.spacing /= by;
        if (const auto sheet = built(fine, mistakes)) part.fine_count = sheet_particles(*sheet);
      }
      parts_.push_back(part), first += part.fine_count;
    }
    for (const SupportTable& s : problem.supports) held_.insert(s.group);
    for (auto g = problem.groups.rbegin(); g != problem.groups.rend(); ++g)
      if (held_.count(g->name)) held_.insert(g->of.begin(), g->of.end());
  }

  struct Part : Structure {
    std::optional<Row> row;
    int fine_first, fine_count;          // its particles, refined
    double spacing;                      // then of a sheet; 0 of all else
  };
  const std::vector<Part>& parts() const { return parts_; }
  bool held(const std::string& group) const { return held_.count(group) > 0; }
  const Part& part_of(int particle) const {
    return *std::ranges::find_if(parts_, [&](const Part& p) { return p.has(particle); });
  }
  /// The row that a group is chosen from, if it is one.
  const Row* row_of(const GroupTable& g) const {
    if (g.of.size() != 1 || g.except) return nullptr;
    const Part* p = g.of[0] == "all" && parts_.size() == 1 ? &parts_[0] : find_named(parts_, g.of[0]);
    return p && p->row ? &*p->row : nullptr;
  }

  /// Sets how a group is chosen now, where that does not stay as it is. Mistakes: see finer_structure.
  void choose(const GroupTable& g, const auto& set, Mistakes& mistakes) const {
    const char* const key = g.first ? "first" : g.last ? "last" : g.middle ? "middle" : g.ids ? "ids" : nullptr;
    const auto refuse = [&](const std::string& why) { mistakes.add(g.place, key, why); };
    if (!key) return;
    bool lost = false;
    std::string value;
    if (g.ids) {
      std::map<const Part*, std::set<int>> of;
      for (const int id : *g.ids) {
        const auto index = static_cast<int>(std::lower_bound(model_.id.begin(), model_.id.end(), id) - model_.id.begin());
        if (index >= model_.particles()) return;                               // a body, or nothing, which is told elsewhere
        const Part& p = part_of(index);
        if (p.spacing > 0) return refuse("are particles of a [[sheet]], which have other ids at another spacing; choose by `inside`");
        of[&p].insert(index - p.first);
      }
      std::vector<int> ids;
      for (const auto& [p, in] : of)
        for (const int i : p->row ? p->row->images(in, held(g.name), lost) : in) ids.push_back(p->fine_first + i + 1);
      std::ranges::sort(ids);
      value = fmt::format("[{}]", fmt::join(ids, ", "));
    } else if (const Row* row = row_of(g)) {
      const int n = g.first ? *g.first : g.last ? *g.last : *g.middle, others = row->count - n, skip = g.first ? 0 : g.last ? others : others / 2;
      if (g.middle && others % 2 != 0)
        return refuse(fmt::format("has no middle that stays, {} of {} particles; take an odd number of them", n, row->count));
      std::set<int> in;
      for (int i = skip; i < skip + n; ++i) in.insert(i);
      value = std::to_string(row->images(in, held(g.name), lost).size());
    } else {
      return;
    }
    if (!lost) return set(key, value);
    refuse("are held neighbours, which clamp a row in the middle of their bond; with an even refine.by no bond has this middle: give by = 3, "
           "or the [[beam]] `clamped` ends");
  }

 private:
  const Model& model_;
  std::vector<Part> parts_;
  std::set<std::string> held_;
};

}  // namespace

std::vector<Setting> finer_structure(const Problem& problem, const Model& model, int by, Mistakes& mistakes) {
  std::vector<Setting> settings;
  const Place place = problem.refine ? Place{problem.refine->place} : Place{};
  const auto setter = [&](const TablePlace& table) {
    return [&settings, &table, place](const char* key, const std::string& value) { settings.push_back({table.key + "." + key, value, place}); };
  };
  const Refined refined(problem, model, by, mistakes);
  const auto keys_of_all = [&](const auto& t, int of_density, const auto& set) {
    if (t.rest_length) set("rest_length", to_toml(*t.rest_length / by));
    if (t.density) set("density", to_toml(*t.density / of_density));
    if (!t.rest.as_built && t.rest.degrees != 180) set("rest", to_toml(180 - (180 - t.rest.degrees) / by));   // the turn from bond to bond is divided
  };
  const auto row_keys = [&](const auto& t, const auto& set) {
    set("particles", std::to_string(find_named(refined.parts(), t.name)->fine_count));
    if (t.bond_stiffness) set("bond_stiffness", to_toml(*t.bond_stiffness * by));
    if (t.angle_stiffness) set("angle_stiffness", to_toml(*t.angle_stiffness * by));
    keys_of_all(t, by, set);
  };
  for (const BeamTable& t : problem.beams) {
    const auto set = setter(t.place);
    row_keys(t, set);
    if (t.center) set("spacing", to_toml(*t.spacing / by));
  }
  for (const LoopTable& t : problem.loops) row_keys(t, setter(t.place));
  for (const SheetTable& t : problem.sheets) {
    const auto set = setter(t.place);
    set("spacing", to_toml(t.spacing / by)), set("thickness", to_toml(*t.thickness)), set("diameter", to_toml(*t.diameter));
    keys_of_all(t, by * by, set);
  }
  for (const GroupTable& g : problem.groups) refined.choose(g, setter(g.place), mistakes);
  for (const ContactTable& c : problem.contacts)
    if (c.exclude_bonds) setter(c.place)("exclude_bonds", std::to_string(*c.exclude_bonds * by));
  return settings;
}

std::vector<Setting> finer_loads(const Problem& coarse, const Model& coarse_model, const Problem& fine, const Model& fine_model, int by,
                                 Mistakes& mistakes) {
  std::vector<Setting> settings;
  const Refined refined(coarse, coarse_model, by, mistakes);
  std::vector<int> image(static_cast<std::size_t>(coarse_model.particles()), -1);
  for (const Refined::Part& part : refined.parts()) {
    const Structure& there = *find_named(fine_model.structures, part.name);
    std::vector<int> at;                                       // of a sheet: which of its particles stands at each place now
    if (part.spacing > 0)
      at = points_at(coarse_model.start.position.middleCols(part.first, part.count), fine_model.start.position.middleCols(there.first, there.count),
                     1e-6 * part.spacing);
    for (int i = 0; i < part.count; ++i)
      if (const int now = part.spacing > 0 ? at[i] : part.row ? part.row->image(i) : i; now >= 0) image[part.first + i] = there.first + now;
  }
  std::set<int> held;                                          // beside the end of what is held the middle of a bond counts
  for (const Support& s : coarse_model.supports) held.insert(s.particles.begin(), s.particles.end());
  std::set<std::string> apart;                                 // regions that the file itself makes smaller with the spacing, and what is made of them
  for (std::size_t k = 0; k < coarse.groups.size(); ++k) {
    const GroupTable &g = coarse.groups[k], &changed = fine.groups[k];
    std::vector<std::string> of = g.of;
    if (g.except) of.insert(of.end(), g.except->begin(), g.except->end());
    const bool of_apart = std::ranges::any_of(of, [&](const std::string& name) { return contains(apart, name); });
    if (of_apart || g.inside != changed.inside || g.outside != changed.outside) {
      apart.insert(g.name);
      continue;
    }
    const Group *before = find_named(coarse_model.groups, g.name), *now = find_named(fine_model.groups, g.name);
    if (!before || !now) continue;
    const std::set<int> was(before->particles.begin(), before->particles.end()), is(now->particles.begin(), now->particles.end());
    for (int i = 0; i < coarse_model.particles(); ++i) {
      const int there = image[i];
      const bool clamps = refined.part_of(i).row && held.count(i) && (held.count(i - 1) || held.count(i + 1));
      if (there < 0 || clamps || (was.count(i) > 0) == (is.count(there) > 0)) continue;
      mistakes.add(g.place, fmt::format("does not stay where it is: particle {} {} it, but with a spacing {} times as fine what is at its place {}; give the "
                                        "region by lengths that do not depend on the spacing, or by a constant that refine.divide names",
                                        coarse_model.id[i], was.count(i) ? "is in" : "is not in", by,
                                        was.count(i) ? "is not" : "is"));
      break;
    }
  }
  for (std::size_t k = 0; k < coarse.loads.size(); ++k) {
    const LoadTable &t = coarse.loads[k], &changed = fine.loads[k];
    const Group *before = find_named(coarse_model.groups, t.group), *now = find_named(fine_model.groups, t.group);
    if (!before || !now || t.force != changed.force || t.radial != changed.radial) continue;
    const auto count = [](const Group& group) { return static_cast<double>(group.particles.size() + group.bodies.size()); };
    const double part = count(*before) / count(*now);
    const Place place = coarse.refine ? Place{coarse.refine->place} : Place{};
    if (t.force) {
      const Vec3 f = *t.force * part;
      settings.push_back({t.place.key + ".force", fmt::format("[{}, {}, {}]", to_toml(f[0]), to_toml(f[1]), to_toml(f[2])), place});
    }
    if (t.radial) settings.push_back({t.place.key + ".radial", to_toml(*t.radial * part), place});
  }
  return settings;
}

}  // namespace elamin
