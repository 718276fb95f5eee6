#include "proof/structure.hpp"

#include "core/near_pairs.hpp"
#include "energy/contact_rules.hpp"
#include "energy/groups.hpp"
#include "energy/kinematics.hpp"
#include "energy/wall_group.hpp"
#include "laws/cosine_angle.hpp"

#include <fmt/format.h>

namespace elamin::proof {

namespace {

std::string what_is_not_covered(const Model& model) {
  if (!model.bodies.empty() || !model.rounded.empty()) return "rigid bodies";
  if (!model.pressures.empty()) return "pressures";
  if (!model.own.empty()) return "the law \"" + model.own.front().term + "\" of a program's own";
  for (const PairContact& c : model.contacts) {
    if (c.law == PairContact::Law::lj) return "cohesion (Lennard-Jones)";
    if (c.hard) return "hard contacts";
  }
  for (const Wall& w : model.walls) {
    const Region& r = w.region;
    const bool endless = r.axial_lo == -HUGE_VAL && r.axial_hi == HUGE_VAL;
    const bool smooth = r.shape == Shape::plane || r.shape == Shape::sphere || (r.shape == Shape::cylinder && endless);
    const bool covered = !r.any_open() && (smooth || (r.shape == Shape::block && w.inside));
    if (w.hard) return "hard walls, as \"" + w.name + "\",";
    if (!covered && !w.particles.empty()) return "walls with rims, edges or open faces, as \"" + w.name + "\",";
  }
  return "";
}

// Calls with the faces of a wall as laws for a particle of radius r; effective radii as in wall_gap.hpp.
void for_faces(const WallContact& wall, double r, const auto& call) {
  const Region& region = wall.region;
  const auto stiffness = [&](double effective) { return wall.effective_modulus * 4 / 3 * std::sqrt(effective); };
  const auto plane = [&](const Vec3& normal, const Vec3& point) { call(Plane{stiffness(r), r, normal, point}); };
  if (region.shape == Shape::plane) return plane(wall.inside ? region.normal : Vec3(-region.normal), region.center);
  for (int c = 0; c < 3 && region.shape == Shape::block; ++c) {
    if (std::isfinite(region.lo[c])) plane(Vec3::Unit(c), region.lo[c] * Vec3::Unit(c));
    if (std::isfinite(region.hi[c])) plane(-Vec3::Unit(c), region.hi[c] * Vec3::Unit(c));
  }
  if (region.shape == Shape::block) return;
  const bool cylinder = region.shape == Shape::cylinder;
  const double m = (cylinder ? 2 : 1) * region.radius, effective = wall.curved ? r * (m / (wall.inside ? m - r : m + r)) : r;
  call(Round{stiffness(effective), r, region.radius, region.center, cylinder ? region.axis : -1, wall.inside});
}

void add_contacts(const Model& model, const State& state, Structure& s) {
  const ContactRules rules(model);
  if (!rules.any()) return;
  std::vector<double> radii(model.particles(), 0.0);
  for (int i = 0; i < model.particles(); ++i)
    if (rules.cutoff_radius(i) > 0) radii[i] = (model.diameter[i] + s.reach) / 2 * (1 + 1e-9);
  for (const auto& [i, j] : near_pairs(state.position, radii, [&](int a, int b) { return rules.hertz(a, b) >= 0; })) {
    const HertzContact law = hertz_contact(model, rules.hertz(i, j), i, j);
    if (law.stiffness > 0) s.contacts.push_back({{law.stiffness, law.contact_distance}, {i, j}});
  }
}

// A wall acts on what has its centre on the wall's side; whose centre is near the surface is not told.
void add_walls(const Model& model, const State& state, Structure& s, std::string& not_covered) {
  for (const Wall& w : model.walls) {
    WallContact wall = wall_at(w, state.load_factor);
    wall.region = wall.region.rounded();
    if (!(wall.effective_modulus > 0)) continue;
    for (const int p : w.particles) {
      const double r = model.diameter[p] / 2;
      const Vector3<Interval<double>> x = s.edge<Interval<double>>(state, -1, p, 0);
      double nearest = HUGE_VAL;                                // of the centre to a face
      for_faces(wall, r, [&](const auto& face) { nearest = std::min(nearest, gap(face, x).lo + r); });
      if (nearest < -s.reach) continue;
      if (nearest < s.reach) not_covered = fmt::format("particles whose centre is at the surface of a wall, as of \"{}\",", w.name);
      for_faces(wall, r, [&]<class Face>(const Face& face) {
        if (gap(face, x).lo <= s.reach) std::get<std::vector<Element<Face, 1>>&>(std::tie(s.planes, s.rounds)).push_back({face, {p}});
      });
    }
  }
}

}  // namespace

Structure structure_of(const Model& model, const State& state, std::string& not_covered) {
  Structure s;
  not_covered = what_is_not_covered(model);
  if (!not_covered.empty()) return s;
  const Kinematics kinematics(model);
  s.load_factor = state.load_factor, s.dofs = kinematics.dofs();
  s.reach = kinematics.smallest_size() / 10;
  for (int p = 0; p < model.particles(); ++p) s.dof.push_back({kinematics.dof(p, 0), kinematics.dof(p, 1), kinematics.dof(p, 2)});
  const std::vector<HarmonicBond> bonds = bond_laws(model, state.load_factor);
  const std::vector<CosineAngle> angles = angle_laws(model, state.load_factor);
  for (std::size_t k = 0; k < bonds.size(); ++k) s.bonds.push_back({{bonds[k].K, bonds[k].r0, bonds[k].r0_tail}, model.bonds[k].particles});
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const double rest = model.angle_types[model.angles[k].type].rest;
    Angle law{angles[k].B, 1, 0, -1};
    if (rest != pi) law.cosine = std::cos(pi - rest), law.sine = std::sin(pi - rest), law.kept = model.plane_normal.value_or(-1);
    s.angles.push_back({law, angle_sites(model, model.angles[k])});
  }
  add_contacts(model, state, s), add_walls(model, state, s, not_covered);
  for (const Load& l : model.loads)
    for (std::size_t k = 0; k < l.particles.size(); ++k) s.loads.push_back({l.particles[k], l.on(k), l.scaling});
  for (const Gravity& g : model.gravity)
    for (const int p : g.particles) s.loads.push_back({p, model.mass(p) * g.acceleration, g.scaling});
  return s;
}

template <class I>
Vector3<I> Structure::edge(const State& centre, int i, int j, double radius) const {
  const I way = I(-radius, radius) * (i < 0 ? I(1) : I(1.4142136));
  Vector3<I> d;
  for (int c = 0; c < 3; ++c) {
    if (i < 0) d[c] = I(centre.position(c, j)) + I(centre.low(c, j));
    else d[c] = (I(centre.position(c, j)) - I(centre.position(c, i))) + (I(centre.low(c, j)) - I(centre.low(c, i)));
    if (radius > 0 && (dof[j][c] >= 0 || (i >= 0 && dof[i][c] >= 0))) d[c] += way;
  }
  return d;
}

template <class I>
void Structure::for_elements(const State& centre, double radius, bool with_hessian, const auto& take) const {
  const auto edge = [&](int i, int j) { return this->edge<I>(centre, i, j, radius); };
  const auto pairs = [&](const auto& elements) {
    for (const auto& [law, at] : elements) {
      const auto [f, b] = derivatives<I>(law, edge(at[0], at[1]), with_hessian);
      take(at, (Eigen::Matrix<I, 6, 1>() << -f, f).finished(), (Eigen::Matrix<I, 6, 6>() << b, -b, -b, b).finished());
    }
  };
  const auto walls = [&](const auto& elements) {
    for (const auto& [law, at] : elements) {
      const OfEdge<I> d = derivatives<I>(law, edge(-1, at[0]), with_hessian);
      take(at, d.gradient, d.hessian);
    }
  };
  pairs(bonds), pairs(contacts);
  for (const auto& [law, at] : angles) {
    const OfEdges<I> d = derivatives<I>(law, edge(at[0], at[1]), edge(at[1], at[2]), with_hessian);
    const Matrix3<I> wu = d.uw.transpose(), first = d.uw - d.uu, last = d.uw - d.ww;
    Eigen::Matrix<I, 9, 1> f;
    Eigen::Matrix<I, 9, 9> h;
    f << -d.u, d.u - d.w, d.w;
    h << d.uu, first, -d.uw, first.transpose(), d.uu + d.ww - d.uw - wu, last, -wu, last.transpose(), d.ww;
    take(at, f, h);
  }
  walls(planes), walls(rounds);
}

std::vector<Interval<Quad>> Structure::gradient(const State& centre) const {
  using I = Interval<Quad>;
  std::vector<I> g(dofs);
  const auto add = [&](int p, const Vector3<I>& f) {
    for (int c = 0; c < 3; ++c)
      if (dof[p][c] >= 0) g[dof[p][c]] += f[c];
  };
  for_elements<I>(centre, 0, false, [&](const auto& at, const auto& f, const auto&) {
    for (std::size_t k = 0; k < at.size(); ++k) add(at[k], f.template segment<3>(3 * k));
  });
  for (const DeadLoad& l : loads) {
    const I part = I(l.scaling.fixed) + I(l.scaling.rate) * I(load_factor);
    add(l.particle, -part * l.force.cast<I>());
  }
  return g;
}

IntervalHessian::IntervalHessian(const Structure& structure, const State& centre) : structure_(structure), pattern_(structure.dofs, structure.dofs) {
  std::vector<Eigen::Triplet<double>> entries;
  structure.for_elements<I>(centre, 0, false, [&](const auto& at, const auto&, const auto&) {
    for (const int p : at)
      for (const int q : at)
        for (const int i : structure.dof[p])
          for (const int j : structure.dof[q])
            if (j >= 0 && i >= j) entries.emplace_back(i, j, 0.0);
  });
  for (int i = 0; i < structure.dofs; ++i) entries.emplace_back(i, i, 0.0);
  pattern_.setFromTriplets(entries.begin(), entries.end());
}

void IntervalHessian::evaluate(const State& centre, double radius) {
  value_.assign(pattern_.nonZeros(), I(0));
  const int *rows = pattern_.innerIndexPtr(), *start = pattern_.outerIndexPtr();
  structure_.for_elements<I>(centre, radius, true, [&](const auto& at, const auto&, const auto& h) {
    for (int r = 0; r < h.rows(); ++r)
      for (int c = 0; c < h.cols(); ++c) {
        const int i = structure_.dof[at[r / 3]][r % 3], j = structure_.dof[at[c / 3]][c % 3];
        if (j >= 0 && i >= j) value_[std::lower_bound(rows + start[j], rows + start[j + 1], i) - rows] += h(r, c);
      }
  });
}

SparseMatrix IntervalHessian::middle(const State& centre) {
  evaluate(centre, 0);
  SparseMatrix M = pattern_;
  std::ranges::transform(value_, M.valuePtr(), &I::middle);
  return M;
}

double IntervalHessian::distance(const SparseMatrix& M, const State& centre, double radius) {
  evaluate(centre, radius);
  std::vector<I> sums(structure_.dofs);
  for (int j = 0; j < pattern_.outerSize(); ++j)
    for (int k = pattern_.outerIndexPtr()[j]; k < pattern_.outerIndexPtr()[j + 1]; ++k) {
      const I off((value_[k] - I(M.valuePtr()[k])).mag());
      const int i = pattern_.innerIndexPtr()[k];
      sums[j] += off;
      if (i != j) sums[i] += off;
    }
  return std::ranges::max(sums, {}, &I::hi).hi;                 // ∞ where there is no bound
}

}  // namespace elamin::proof
