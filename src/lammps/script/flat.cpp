#include "lammps/script/flat.hpp"

#include <algorithm>

namespace elamin::script {
namespace {

/// Whether a wall pushes no particle of at most this radius out of the plane x_c = at.
bool symmetric(const Fix::Wall& w, int c, double at, double most) {
  if (w.moved[0][c] != 0 || w.moved[1][c] != 0) return false;
  const Region& r = w.region;
  const auto faces = [&](double lo, double hi) { return hi - at == at - lo || (at - lo >= most && hi - at >= most); };
  switch (r.shape) {
    case Shape::plane: return r.normal[c] == 0 || (at - r.center[c]) * r.normal[c] >= most;
    case Shape::block: return w.inside && !r.any_open() && faces(r.lo[c], r.hi[c]);
    case Shape::sphere: return r.center[c] == at;
    case Shape::cylinder:
    case Shape::cone:
      return r.axis == c ? w.inside && !r.any_open() && r.shape == Shape::cylinder && faces(r.axial_lo, r.axial_hi) : r.center[c] == at;
  }
  return false;
}

}  // namespace

int flat(const World& world, const Particles& particles) {
  const auto atom_of = [&](int i) -> const Atom& { return world.atoms[static_cast<std::size_t>(i)]; };
  if (particles.bodies() > 0 || particles.particles() == 0) return -1;
  double most = 0;                              // of the radii
  for (const int i : particles.atoms()) most = std::max(most, atom_of(i).diameter / 2);
  for (int c = 0; c < 3; ++c) {
    const double at = atom_of(particles.atoms().front()).start[c];
    const auto keeps = [&](const Run::Active& a) {
      const Fix& f = a.fix;
      if (f.kind == Fix::Kind::gravity || f.kind == Fix::Kind::force || f.kind == Fix::Kind::move)
        return f.vector[c] == 0 && f.end[c] == 0 &&
               std::all_of(a.own.begin(), a.own.end(), [&](const auto& own) { return own[0][c] == 0 && own[1][c] == 0; });
      return f.kind != Fix::Kind::wall ||
             std::all_of(f.walls.begin(), f.walls.end(), [&](const Fix::Wall& w) { return symmetric(w, c, at, most); });
    };
    bool flat = std::all_of(particles.atoms().begin(), particles.atoms().end(),
                            [&](int i) { return atom_of(i).start[c] == at && atom_of(i).v[c] == 0; });
    for (const Run& run : world.runs)
      flat = flat && std::all_of(run.fixes.begin(), run.fixes.end(), [&](const Run::Active& a) { return keeps(a); });
    if (flat) return c;
  }
  return -1;
}

}  // namespace elamin::script
