#include "model/sheet.hpp"

#include "model/append.hpp"
#include "model/geometry.hpp"
#include "model/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace elamin {
namespace {

constexpr double on_edge = 1e-9;                 // of the spacing
constexpr double most_around = 1e7;                // spacings around a cylinder

/// √3/2 |C|⁻¹ times the spacing of the rolled lattice, √3πR/|C|²: a step up the cylinder.
Exact step_up(const Sheet& s, const Outline& o) {
  return square_root(exact(3)) * exact_pi * exact(s.radius) / exact(static_cast<double>(o.square()));
}

/// The part of a turn around the cylinder.
Exact turn(const Outline& o, const LatticePoint& p) {
  return exact(static_cast<double>(o.around(p))) / exact(2 * static_cast<double>(o.square()));
}

Outline outline_of(const Sheet& s) {
  Outline o;
  if (s.shape == Sheet::Shape::rectangle) {
    const auto [cosine, sine] = cosine_sine(turns(s.lattice_angle));
    o.width = s.size[0] / s.spacing, o.height = s.size[1] / s.spacing;
    o.cosine = cosine.hi, o.sine = sine.hi;
  } else if (s.shape == Sheet::Shape::circle) {
    o.kind = Outline::Kind::circle;
    o.width = s.radius / s.spacing;
  } else {
    const Rolled r = rolled(s);
    o.kind = Outline::Kind::rolled;
    o.n1 = r.n1, o.n2 = r.n2;
    o.height = std::floor((s.height + on_edge * s.spacing) / step_up(s, o).hi);
  }
  return o;
}

/// A bond of the cylinder along one direction of the lattice, and two of them in a row.
struct Chord {
  double length, angle;
};
Chord chord_along(const Sheet& s, const Outline& o, const LatticePoint& d) {
  // Length² = 4R² sin²(φ/2) + z², and the turn ψ from one to the next: sin(ψ/2) = 2R sin²(φ/2)/length.
  const Exact half = cosine_sine(turn(o, d) * exact(0.5)).sine, across = exact(2) * exact(s.radius) * half;
  const Exact up = exact(static_cast<double>(o.up(d))) * step_up(s, o);
  const Exact length = norm({{across.hi, up.hi, 0}, {across.lo, up.lo, 0}});
  return {length.value(), exact_pi.hi - 2 * std::asin(std::abs((across * half / length).value()))};
}

struct Types {
  int bond, angle;                                 // the first ones
  int bonds, angles;                               // 1, or one a direction
};
Types add_types(Model& model, const Sheet& s, const Outline& outline) {
  const bool round = s.shape == Sheet::Shape::cylinder;
  Types t{static_cast<int>(model.bond_types.size()), static_cast<int>(model.angle_types.size()), 1, 1};
  if (round && s.rest_length == 0) t.bonds = 3;
  if (round && s.as_built) t.angles = 3;
  for (int d = 0; d < 3; ++d) {
    const Chord built = round ? chord_along(s, outline, lattice_directions[d]) : Chord{s.spacing, exact_pi.hi};
    if (d < t.bonds) add_type(model, BondType{s.bond_stiffness, s.rest_length > 0 ? s.rest_length : built.length});
    if (s.angle_stiffness > 0 && d < t.angles) add_type(model, AngleType{s.angle_stiffness, s.as_built ? built.angle : s.rest});
  }
  return t;
}

void place(State& state, int first, const Sheet& s, const Outline& outline, const LatticePatch& patch) {
  const Frame frame = frame_of(s.normal);
  const auto number = [](std::int64_t k) { return exact(static_cast<double>(k)); };
  if (s.shape == Sheet::Shape::cylinder) {
    const Exact step = step_up(s, outline), radius = exact(s.radius), low = exact(-s.height / 2);
    patch.for_each([&](int k, const LatticePoint& p) {
      const auto [cosine, sine] = cosine_sine(turn(outline, p));
      state.set(first + k, frame.point(s.center, radius * cosine, radius * sine, low + number(outline.up(p)) * step));
    });
    return;
  }
  const Exact angle = turns(s.lattice_angle);
  const auto along = cosine_sine(angle), next = cosine_sine(angle + exact(1) / exact(6));
  const Exact a = exact(s.spacing);
  const Exact au = a * along.cosine, av = a * along.sine, bu = a * next.cosine, bv = a * next.sine;
  const bool corner = s.shape == Sheet::Shape::rectangle;
  const Exact u = exact(corner ? -s.size[0] / 2 : 0), v = exact(corner ? -s.size[1] / 2 : 0);
  patch.for_each([&](int k, const LatticePoint& p) {
    const Exact i = number(p.i), j = number(p.j);
    state.set(first + k, frame.point(s.center, u + i * au + j * bu, v + i * av + j * bv));
  });
}

}  // namespace

Rolled rolled(const Sheet& s) {
  const double around = 2 * exact_pi.hi * s.radius / s.spacing;
  if (!(around < most_around)) return {};
  const auto [cosine, sine] = cosine_sine(turns(s.lattice_angle));
  const double x = around * cosine.hi, y = -around * sine.hi, height = std::sqrt(3) / 2;
  Rolled r;
  double nearest = infinity;
  for (int k = -1; k <= 2; ++k) {
    const double n2 = std::floor(y / height) + k, n1 = std::round(x - n2 / 2);
    const double off = std::hypot(n1 + n2 / 2 - x, n2 * height - y);
    if (off < nearest - 1e-9) nearest = off, r.n1 = static_cast<int>(n1), r.n2 = static_cast<int>(n2);
  }
  const double n1 = r.n1, n2 = r.n2, square = n1 * n1 + n1 * n2 + n2 * n2;
  r.closes = square > 4;
  r.spacing = square > 0 ? 2 * exact_pi.hi * s.radius / std::sqrt(square) : 0;
  return r;
}

int sheet_particles(const Sheet& s) {
  if (s.shape == Sheet::Shape::cylinder) {
    if (!(2 * exact_pi.hi * s.radius / s.spacing < most_around)) return std::numeric_limits<int>::max();
    if (!rolled(s).closes) return 0;
  }
  return count_points(outline_of(s));
}

void add_sheets(Model& model, const std::vector<Sheet>& sheets) {
  std::vector<LatticePatch> patches;
  int more = 0;
  for (const Sheet& s : sheets) more += patches.emplace_back(outline_of(s)).size();
  Appender append(model, more);
  model.bonds.reserve(model.bonds.size() + 3 * static_cast<std::size_t>(more));
  model.angles.reserve(model.angles.size() + 3 * static_cast<std::size_t>(more));
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    const Sheet& s = sheets[k];
    const LatticePatch& patch = patches[k];
    const Outline outline = outline_of(s);
    const int first = append.together(patch.size(), s.diameter, s.density);
    place(model.start, first, s, outline, patch);
    const Types types = add_types(model, s, outline);
    patch.for_each([&](int here, const LatticePoint& p) {
      for (int d = 0; d < 3; ++d) {
        const auto [di, dj] = lattice_directions[d];
        const int ahead = patch.find({p.i + di, p.j + dj});
        if (ahead < 0) continue;
        model.bonds.push_back({types.bond + d % types.bonds, {first + here, first + ahead}});
        const int behind = patch.find({p.i - di, p.j - dj});
        if (behind < 0 || s.angle_stiffness == 0) continue;
        model.angles.push_back({types.angle + d % types.angles, {first + behind, first + here, first + ahead}});
      }
    });
    model.structures.push_back({s.name, "sheet", first, patch.size(), s.youngs_modulus, types.bond, s.angle_stiffness > 0 ? types.angle : -1});
    const Frame frame = frame_of(s.normal);
    model.structures.back().up = s.shape == Sheet::Shape::cylinder ? frame.n.hi : frame.e2.hi;
  }
}

std::vector<std::array<int, 3>> lattice_triangles(const Model& model, const Structure& structure, const Vec3& center, const Vec3& normal, bool tube) {
  const int first = structure.first, end = first + structure.count;
  std::vector<std::vector<int>> ahead(structure.count);          // bonded particles with larger numbers
  for (const Bond& b : model.bonds) {
    const auto [i, j] = std::minmax(b.particles[0], b.particles[1]);
    if (i >= first && j < end) ahead[i - first].push_back(j);
  }
  for (auto& list : ahead) std::sort(list.begin(), list.end());
  std::vector<std::array<int, 3>> triangles;
  const auto at = [&](int p) { return Vec3(model.start.position.col(p)); };
  for (int i = first; i < end; ++i)
    for (const int j : ahead[i - first])
      for (const int k : ahead[i - first]) {
        if (k <= j || !std::binary_search(ahead[j - first].begin(), ahead[j - first].end(), k)) continue;
        Vec3 outwards = normal;
        if (tube) {
          outwards = (at(i) + at(j) + at(k)) / 3 - center;
          outwards -= outwards.dot(normal) * normal;
        }
        const bool with = (at(j) - at(i)).cross(at(k) - at(i)).dot(outwards) > 0;
        triangles.push_back(with ? std::array{i, j, k} : std::array{i, k, j});
      }
  return triangles;
}

std::vector<std::array<int, 2>> rim_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : triangles)
    for (int s = 0; s < 3; ++s) edges.insert({t[s], t[(s + 1) % 3]});
  std::vector<std::array<int, 2>> rim;
  for (const auto& [i, j] : edges)
    if (!edges.count({j, i})) rim.push_back({i, j});
  return rim;
}

}  // namespace elamin
