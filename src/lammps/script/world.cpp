#include "lammps/script/world.hpp"

#include "core/suggest.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin::script {

std::optional<int> World::find_group(const std::string& name) const {
  const auto found = std::find(groups.begin(), groups.end(), name);
  return found == groups.end() || name.empty() ? std::nullopt : std::optional(static_cast<int>(found - groups.begin()));
}

int World::group(const std::string& name, std::size_t word) const {
  if (const auto found = find_group(name)) return *found;
  std::vector<std::string> names;
  std::copy_if(groups.begin(), groups.end(), std::back_inserter(names), [](const std::string& g) { return !g.empty(); });
  throw Wrong(word, in_quotes(name) + " is no group; there are: " + listed(names) + did_you_mean(name, names));
}

char World::kind_of_side(int c, int end) const {
  const std::string& b = boundary[c];
  return end == 1 ? b.back() : b.front();
}

void World::set_box(const std::array<Vec3, 2>& sides) {
  has_box = true;
  box = least_box = sides, room = 1e-4 * (box[1] - box[0]);
  for (int c = 0; c < 3; ++c)
    for (int end = 0; end < 2; ++end)
      if (kind_of_side(c, end) == 's') box[end][c] += end == 1 ? room[c] : -room[c];
}

void World::shrink_box() {
  std::vector<const Atom*> here;
  for (const Atom& a : atoms)
    if (there(a)) here.push_back(&a);
  if (here.empty()) return;
  const bool known = std::none_of(here.begin(), here.end(), [](const Atom* a) { return a->moved; });
  for (int c = 0; c < 3; ++c)
    for (std::size_t end = 0; end < 2; ++end) {
      const char kind = kind_of_side(c, static_cast<int>(end));
      if (kind != 's' && kind != 'm') continue;
      lost[end][c] = !known;
      const double sign = end == 1 ? 1 : -1;
      double most = sign * here.front()->x[c];
      for (const Atom* a : here) most = std::max(most, sign * a->x[c]);
      most += room[c];
      if (kind == 'm') most = std::max(most, sign * least_box[end][c]);
      box[end][c] = sign * most;
    }
}

double World::side(int c, int end) const {
  if (lost[end][c]) throw NeedsPositions{last_run};
  return box[end][c];
}

bool World::in_box(const Vec3& x) const {
  for (int c = 0; c < 3; ++c)
    if ((!lost[0][c] && x[c] < box[0][c]) || (!lost[1][c] && x[c] >= box[1][c])) return false;
  return true;
}

double World::mass_of(const Atom& a) const {
  if (sphere) return a.diameter > 0 ? a.density * pi / 6 * a.diameter * a.diameter * a.diameter : a.density;
  return a.type <= static_cast<int>(mass.size()) ? mass[a.type - 1] : 0;
}

namespace {

Coefficient coefficient(const std::vector<Coefficient>& all, int type, const std::string& style, const std::string& what) {
  const Coefficient& c = all[type - 1];
  if (style == "none") return {0, what == "angle" ? pi : 0, true};
  if (!c.set) throw Wrong(0, fmt::format("{}s of type {} have no coefficients; {}_coeff gives them", what, type, what));
  return c;
}

}  // namespace

Coefficient World::of_bonds(int type) const { return coefficient(bond_coefficients, type, bond_style, "bond"); }
Coefficient World::of_angles(int type) const { return coefficient(angle_coefficients, type, angle_style, "angle"); }

const Vec3& World::at(const Atom& a) const {
  if (a.moved) throw NeedsPositions{last_run};
  return a.x;
}

void World::change(const Atom& a, bool changes) const {
  if (changes && a.born < run_number()) throw NeedsPositions{last_run, "changes what was there in"};
}

bool World::matches(const std::string& name, const Vec3& x, std::size_t word, int depth) const {
  const auto found = regions.find(name);
  if (found == regions.end()) {
    std::vector<std::string> names;
    for (const auto& [known, region] : regions) names.push_back(known);
    throw Wrong(word, in_quotes(name) + " is no region; " + (names.empty() ? "there is none" : "there are: " + listed(names)) +
                          did_you_mean(name, names));
  }
  if (depth > 20) throw Wrong(word, in_quotes(name) + " is made of too many regions in each other");
  const ScriptRegion& r = found->second;
  if (r.moves) throw Wrong(word, in_quotes(name) + " moves; where it is is not followed", true);
  bool within;
  if (r.kind == ScriptRegion::Kind::shape) {
    if (r.shape.any_open()) return true;         // of LAMMPS, too: what has an open face is everywhere
    within = r.shape.contains(x);
  } else {
    const bool all = r.kind == ScriptRegion::Kind::intersect;
    within = all;
    for (const std::string& part : r.parts)
      if (matches(part, x, word, depth + 1) != all) within = !all;
  }
  return within == r.inside;
}

bool World::is_of_now(const Run& run) const {
  std::vector<int> now;
  for (std::size_t k = 0; k < atoms.size(); ++k)
    if (there(atoms[k])) now.push_back(static_cast<int>(k));
  const auto known = [](const auto& glue, const std::map<int, Coefficient>& types) {
    return std::all_of(glue.begin(), glue.end(), [&](const auto& g) { return g.gone != always || types.count(g.type); });
  };
  return now == run.atoms && known(bonds, run.bonds) && known(angles, run.angles);
}

int World::with_id(long long id, std::size_t word) const {
  if (id >= 1 && id < static_cast<long long>(of_id.size()) && of_id[id] >= 0)
    return of_id[id];
  throw Wrong(word, fmt::format("there is no atom {}", id));
}

Atom& World::create(int type, const Vec3& x) {
  Atom a;
  while (of_id.size() > 1 && of_id.back() < 0) of_id.pop_back();       // the next id is behind the largest one
  if (of_id.empty()) of_id.push_back(-1);
  a.id = static_cast<int>(of_id.size());
  a.type = type, a.x = a.start = x, a.born = run_number();
  if (sphere) a.diameter = 1, a.density = 1;
  of_id.push_back(static_cast<int>(atoms.size()));
  return atoms.emplace_back(a);
}

void World::new_glue(std::initializer_list<int> indices) const {
  if (runs.empty()) return;
  for (const int i : indices)
    if (atoms[i].born == run_number()) return;
  throw NeedsPositions{last_run};
}

void World::remove(Atom& a) {
  of_id[a.id] = -1;
  a.gone = run_number();
}

void World::remove(const std::vector<bool>& gone) {
  for (std::size_t i = 0; i < atoms.size(); ++i)
    if (gone[i] && there(atoms[i])) remove(atoms[i]);
  const auto end = [&](auto& list) {
    for (auto& glue : list)
      if (glue.gone == always && std::any_of(glue.atoms.begin(), glue.atoms.end(), [&](int i) { return gone[i]; }))
        glue.gone = run_number();
  };
  end(bonds), end(angles);
}

}  // namespace elamin::script
