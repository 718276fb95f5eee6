#include "lammps/script/held.hpp"

#include <algorithm>

namespace elamin::script {
namespace {

Vec3 only(const Vec3& v, const std::array<bool, 3>& directions) {
  Vec3 r = Vec3::Zero();
  for (std::size_t c = 0; c < 3; ++c)
    if (directions[c]) r[static_cast<Eigen::Index>(c)] = v[static_cast<Eigen::Index>(c)];
  return r;
}

}  // namespace

std::map<Held, std::vector<int>> held_in(const World& world, const Run& run) {
  const std::size_t n = world.atoms.size();
  std::vector<char> integrated(n, run.minimize);
  for (const Run::Active& a : run.fixes)
    if (a.fix.integrates())
      for (const int i : a.members) integrated[i] = 1;
  std::vector<std::vector<Held>> held(n);
  const std::array<bool, 3> whole{true, true, true};
  for (const int i : run.atoms)
    if (!integrated[i]) held[i].push_back({whole, Vec3::Zero(), -1});
  for (std::size_t f = 0; f < run.fixes.size(); ++f) {
    const Run::Active& a = run.fixes[f];
    const bool moves = a.fix.kind == Fix::Kind::move;
    if ((moves || a.fix.unforced) ? run.minimize : a.fix.kind != Fix::Kind::hold) continue;
    for (const int i : a.members) {
      auto& list = held[i];
      if (!list.empty() && list[0].fix < 0 && !moves) continue;
      const bool stands = run.still() || run.minimize;
      const Vec3 v = stands ? Vec3(Vec3::Zero()) : moves ? a.fix.vector : world.atoms[i].v;
      for (Held& h : list)                    // the later fix has the last word
        for (std::size_t c = 0; c < 3; ++c)
          if (a.fix.directions[c]) h.directions[c] = false, h.velocity[static_cast<Eigen::Index>(c)] = 0;
      std::erase_if(list, [](const Held& h) { return h.directions == std::array<bool, 3>{}; });
      if (a.fix.directions != std::array<bool, 3>{}) list.push_back({a.fix.directions, only(v, a.fix.directions), static_cast<int>(f)});
    }
  }
  std::map<Held, std::vector<int>> by;
  for (const int i : run.atoms)
    for (const Held& h : held[i]) by[h].push_back(i);
  return by;
}

}  // namespace elamin::script
