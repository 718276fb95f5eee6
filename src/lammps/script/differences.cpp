#include "lammps/script/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace elamin::script {
namespace {

using Members = std::vector<int>;               // indices of World::atoms, ascending

bool meet(const Members& a, const Members& b) {
  return std::any_of(a.begin(), a.end(), [&](int i) { return std::binary_search(b.begin(), b.end(), i); });
}

/// A sentence where pairs of these types have coefficients that LAMMPS takes otherwise than they read, or "".
std::string misread(const Pairs& pairs, const std::vector<int>& types) {
  const auto named = [](const auto& list, const std::string& style) {
    return std::any_of(list.begin(), list.end(), [&](const auto& c) { return c.style == style; });
  };
  const auto& said = pairs.coefficients;
  const char *grains = "granular", *older = "gran/hertz/history";
  const bool takes_back = named(said, "none"), two = pairs.overlay && named(said, grains) && named(said, older);
  if (!takes_back && !two) return "";
  const auto styles = [&](int i, int j) {
    std::set<std::string> all;
    for (const PairCoefficient& c : said) {
      if (!c.covers(i, j)) continue;
      if (pairs.hybrid || c.style == "none") all.clear();
      if (c.style != "none") all.insert(c.style);
    }
    return all;
  };
  for (std::size_t a = 0; a < types.size(); ++a)
    for (std::size_t b = a; b < types.size(); ++b) {
      const int i = types[a], j = types[b];
      const std::set<std::string> both = styles(i, j);
      if (both.count(grains) && both.count(older))
        return fmt::format("LAMMPS adds the contacts of {} and {} between types {} and {}; one of them is taken", grains, older, i, j);
      const auto last = std::find_if(said.rbegin(), said.rend(), [&](const PairCoefficient& c) { return c.covers(i, j); });
      if (last == said.rend() || last->style != "none") continue;
      const std::set<std::string> one = styles(i, i);
      if (one.size() == 1 && !one.count("zero") && one == styles(j, j))
        return fmt::format("`none` between types {} and {}, which both have {} alone, ends nothing in LAMMPS, which takes "
                           "their coefficients still; without stiffness they end it: `granular hertz 0 0 tangential linear_nohistory 0 0`, "
                           "`lj/cut 0 1`",
                           i, j, *one.begin());
    }
  return "";
}

/// Whether a fix pushes in one of these directions.
bool pushes(const Run::Active& a, const std::array<bool, 3>& directions) {
  for (int c = 0; c < 3; ++c)
    if (directions[c] &&
        (a.fix.vector[c] != 0 || a.fix.end[c] != 0 ||
         std::any_of(a.own.begin(), a.own.end(), [&](const auto& own) { return own[0][c] != 0 || own[1][c] != 0; })))
      return true;
  return false;
}

/// LAMMPS lets fixes act one after the other: what comes behind the fix that sets a force to zero moves what that holds.
void pushed(const Run& run, std::vector<Difference>& all) {
  for (const auto& [h, members] : run.held) {
    if (h.fix < 0 || run.still()) continue;
    const Fix& hold = run.fixes[h.fix].fix;
    if (hold.kind != Fix::Kind::hold || hold.unforced) continue;
    for (std::size_t f = static_cast<std::size_t>(h.fix) + 1; f < run.fixes.size(); ++f) {
      const Run::Active& a = run.fixes[f];
      const bool wall = a.fix.kind == Fix::Kind::wall, load = a.fix.kind == Fix::Kind::force || a.fix.kind == Fix::Kind::gravity;
      const bool drags = a.fix.kind == Fix::Kind::viscous && !h.velocity.isZero(0);
      if (run.minimize && a.fix.kind != Fix::Kind::force) continue;
      if (!(wall || drags || (load && pushes(a, h.directions))) || !meet(members, a.members)) continue;
      all.push_back({a.fix.where, "",
                     fmt::format("LAMMPS lets {}, which comes behind the fix {}, move what that holds; here it stays held", wall ? "this wall" : "the fix " + a.fix.id,
                                 hold.id)});
    }
  }
}

}  // namespace

std::vector<Difference> differences(const World& world, const Run& run) {
  std::vector<Difference> all;
  std::set<int> types;
  for (const int i : run.atoms) types.insert(world.atoms[i].type);
  if (const std::string what = misread(run.pairs, {types.begin(), types.end()}); !what.empty())
    all.push_back({run.where, "pair_coeff", what});
  pushed(run, all);
  for (const Run::Active& a : run.fixes) {
    const auto& walls = a.fix.walls;
    if (run.minimize && (a.fix.kind == Fix::Kind::gravity || a.fix.kind == Fix::Kind::wall || a.fix.style == "freeze"))
      all.push_back({a.fix.where, "", fmt::format("LAMMPS's minimize leaves out fixes of style {}; here they act in it", a.fix.style)});
    if (a.fix.style != "wall/gran" || walls.size() != 2) continue;
    double most = 0;
    for (const int i : a.members) most = std::max(most, world.atoms[i].diameter);
    const double gap = (walls[1].region.center - walls[0].region.center).norm();
    if (most > gap)
      all.push_back({a.fix.where, "",
                     fmt::format("these plates are {} apart, and a particle of diameter {} touches both: LAMMPS lets it feel the "
                                 "nearer one alone, here it feels both", gap, most)});
  }
  return all;
}

std::optional<Difference> clamp(const World& world, const Run& run) {
  for (const auto& [h, members] : run.held) {
    if (h.directions != std::array{true, true, true} || members.size() == run.atoms.size()) continue;
    for (const auto& b : world.bonds) {
      const auto holds = [&, &of = members](int i) { return std::binary_search(of.begin(), of.end(), i); };
      if (!holds(b.atoms[0]) || !holds(b.atoms[1])) continue;
      return Difference{h.fix < 0 ? run.where : run.fixes[h.fix].fix.where, "",
                        "bonded particles are held beside each other: a clamp. It sits in the middle of the innermost held bond, so that a "
                        "beam of N free particles bends over N + 2 spacings (docs/column.md)"};
    }
  }
  return std::nullopt;
}

}  // namespace elamin::script
