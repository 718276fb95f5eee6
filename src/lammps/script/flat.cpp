#include "lammps/script/flat.hpp"

#include <algorithm>
#include <tuple>

namespace elamin::script {
namespace {

/// Faces of walls that are parallel to a plane and push particles that lie in it: how far away they are, their modulus, and whom they push.
using Faces = std::vector<std::tuple<double, double, std::vector<int>>>;

/// What lies in the plane x_c = at, with radii up to `most`.
struct Plane {
  int c;
  double at, most;
  Faces below, above;                           // that push upward, downward

  /// Whether a wall pushes nothing out of it but by its faces, which are taken down.
  bool keeps(const Run::Active& a, const Fix::Wall& w) {
    if (w.moved[0][c] != 0 || w.moved[1][c] != 0) return false;
    const Region& r = w.region;
    const auto between = [&](double lo, double hi) {
      if (!w.inside || r.any_open()) return false;
      if (at < lo || at > hi) return a.fix.style != "wall/gran";     // of regions LAMMPS lets those feel nothing that are on the other side
      if (at - lo < most) below.emplace_back(at - lo, w.effective_modulus, a.members);
      if (hi - at < most) above.emplace_back(hi - at, w.effective_modulus, a.members);
      return true;
    };
    switch (r.shape) {
      case Shape::plane: return r.normal[c] == 0 || (at - r.center[c]) * r.normal[c] >= most;
      case Shape::block: return between(r.lo[c], r.hi[c]);
      case Shape::sphere: return r.center[c] == at;
      case Shape::cylinder:
      case Shape::cone: return r.axis != c ? r.center[c] == at : r.shape == Shape::cylinder && between(r.axial_lo, r.axial_hi);
    }
    return false;
  }

  bool keeps(const Run::Active& a) {
    const Fix& f = a.fix;
    if (f.kind == Fix::Kind::gravity || f.kind == Fix::Kind::force || f.kind == Fix::Kind::move)
      return f.vector[c] == 0 && f.end[c] == 0 &&
             std::all_of(a.own.begin(), a.own.end(), [&](const auto& own) { return own[0][c] == 0 && own[1][c] == 0; });
    return f.kind != Fix::Kind::wall || std::all_of(f.walls.begin(), f.walls.end(), [&](const Fix::Wall& w) { return keeps(a, w); });
  }

  /// Whether nothing in force in a run pushes out of it: what pushes up pushes down as much.
  bool keeps(const Run& run) {
    below.clear(), above.clear();
    if (!std::all_of(run.fixes.begin(), run.fixes.end(), [&](const Run::Active& a) { return keeps(a); })) return false;
    std::sort(below.begin(), below.end()), std::sort(above.begin(), above.end());
    return below == above;
  }
};

}  // namespace

Flat flat(const World& world, const Particles& particles) {
  const auto atom_of = [&](int i) -> const Atom& { return world.atoms[i]; };
  Flat best;
  if (particles.bodies() > 0 || particles.particles() == 0) return best;
  for (int c = 0; c < 3; ++c) {
    Plane plane{c, atom_of(particles.atoms().front()).start[c], 0, {}, {}};
    const auto holds = [&](const std::vector<int>& atoms) {
      for (const int i : atoms) plane.most = std::max(plane.most, atom_of(i).diameter / 2);
      return std::all_of(atoms.begin(), atoms.end(), [&](int i) { return atom_of(i).start[c] == plane.at && atom_of(i).start_v[c] == 0; });
    };
    const auto first =
        std::find_if(world.runs.begin(), world.runs.end(), [&](const Run& run) {
          return run.thrown[c] || !holds(run.atoms) || !plane.keeps(run);
        });
    const Flat found{c, static_cast<int>(first - world.runs.begin()), first == world.runs.end() && holds(particles.atoms())};
    if (found.always && !best.always) best = found;
    if (found.runs > best.runs && !best.always) best = found;
  }
  return best;
}

}  // namespace elamin::script
