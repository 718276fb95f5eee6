#include "results/fields.hpp"

#include "energy/groups.hpp"
#include "energy/wall_group.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

/// Three particles with bonds between them, anticlockwise about the normal of their sheet; bond k is between corners k and k + 1.
struct Triangle {
  std::array<int, 3> corners, bonds;
};

/// A bond that begins at a particle.
struct Edge {
  int end, bond;
};

/// The triangles of a sheet. Of a particle the bonds to its neighbours at 0°, 60° and 120° are in this order in the model (see add_sheets):
/// two that follow each other, and the bond between their ends, are a triangle.
std::vector<Triangle> triangles_of(const Model& model, const Structure& sheet) {
  std::vector<std::vector<Edge>> from(sheet.count);
  for (std::size_t b = 0; b < model.bonds.size(); ++b)
    if (const auto [i, j] = model.bonds[b].particles; sheet.has(i) && sheet.has(j)) from[i - sheet.first].push_back({j, static_cast<int>(b)});
  const auto between = [&](int i, int j) {
    for (const auto& [begin, end] : {std::pair(i, j), std::pair(j, i)})
      for (const Edge& e : from[begin - sheet.first])
        if (e.end == end) return e.bond;
    return -1;
  };
  std::vector<Triangle> all;
  for (int i = 0; i < sheet.count; ++i)
    for (std::size_t k = 0; k + 1 < from[i].size(); ++k) {
      const Edge &a = from[i][k], &b = from[i][k + 1];
      if (const int third = between(a.end, b.end); third >= 0) all.push_back({{sheet.first + i, a.end, b.end}, {a.bond, third, b.bond}});
    }
  return all;
}

/// A triangle in its plane: normal, area, and a frame in it, the first direction along the first side.
struct Facet {
  std::array<Vec3, 3> sides;                      // from each corner to the next
  Vec3 normal, along, across;
  double area;

  Facet(const State& state, const std::array<int, 3>& corners) {
    for (int k = 0; k < 3; ++k) sides[k] = (state.at(corners[(k + 1) % 3]) - state.at(corners[k])).hi;
    const Vec3 n = sides[0].cross(sides[1]);
    area = n.norm() / 2, normal = n / (2 * area), along = sides[0].normalized(), across = normal.cross(along);
  }
  Eigen::Vector2d in(const Vec3& v) const { return {v.dot(along), v.dot(across)}; }
};

/// The first axis of the sheet in a triangle: as built, e1 = up × n, and turned with the rotation R of the deformation F = R U that took the
/// triangle from there, tan ψ = (F₂₁ − F₁₂)/(F₁₁ + F₂₂).
Vec3 first_axis(const Facet& built, const Facet& now, const Vec3& up) {
  const Eigen::Vector2d e1 = built.in(up.cross(built.normal)).normalized();
  Eigen::Matrix2d from, to;
  from << built.in(built.sides[0]), built.in(built.sides[1]);
  to << now.in(now.sides[0]), now.in(now.sides[1]);
  const Eigen::Matrix2d F = to * from.inverse();
  const double psi = std::atan2(F(1, 0) - F(0, 1), F(0, 0) + F(1, 1)), c = std::cos(psi), s = std::sin(psi);
  return (c * e1[0] - s * e1[1]) * now.along + (s * e1[0] + c * e1[1]) * now.across;
}

/// Components 11, 22, 12 of v vᵀ.
Vec3 square(const Vec3& v, const Vec3& e1, const Vec3& e2) {
  const double a = v.dot(e1), b = v.dot(e2);
  return {a * a, b * b, a * b};
}

/// What the triangles beside a particle tell.
struct Patch {
  int triangles = 0;
  double area = 0;
  Vec3 normal = Vec3::Zero(), e1 = Vec3::Zero();  // sums
};

}  // namespace

std::array<double, 2> principal(const Vec3& t) {
  const double mean = (t[0] + t[1]) / 2, radius = std::hypot((t[0] - t[1]) / 2, t[2]);
  return {mean + radius, mean - radius};
}

std::vector<StressResultants> stress_resultants(const Model& model, const State& state, const std::vector<BondField>& bonds,
                                                const std::vector<AngleField>& angles) {
  std::vector<StressResultants> all;
  for (const Structure& sheet : model.structures) {
    if (sheet.kind != "sheet") continue;
    all.resize(model.particles());
    std::vector<Patch> cells(sheet.count);
    for (const Triangle& t : triangles_of(model, sheet)) {
      const Facet built(model.start, t.corners), now(state, t.corners);
      if (!(built.area > 0 && now.area > 0)) continue;
      const Vec3 e1 = first_axis(built, now, sheet.up), e2 = now.normal.cross(e1);
      Vec3 N = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        const BondField& bond = bonds[t.bonds[k]];
        N += bond.tension / (2 * now.area * bond.length) * square(now.sides[k], e1, e2);
      }
      for (const int i : t.corners) {
        Patch& cell = cells[i - sheet.first];
        ++cell.triangles, cell.area += now.area, cell.normal += now.area * now.normal, cell.e1 += e1;
        all[i].N += N;
      }
    }
    for (int k = 0; k < sheet.count; ++k) {
      Patch& cell = cells[k];
      StressResultants& r = all[sheet.first + k];
      r.known = cell.triangles > 0;
      if (!r.known) continue;
      r.N /= cell.triangles, cell.area *= 2.0 / cell.triangles;
      cell.normal.normalize(), cell.e1 = (cell.e1 - cell.e1.dot(cell.normal) * cell.normal).normalized();
    }
    for (std::size_t a = 0; a < model.angles.size(); ++a) {
      const auto [i, j, k] = model.angles[a].particles;
      if (std::min({i, j, k}) < sheet.first || std::max({i, j, k}) >= sheet.first + sheet.count || !all[j].known) continue;
      const Patch& cell = cells[j - sheet.first];
      const Vec3 u = (state.at(j) - state.at(i)).hi, w = (state.at(k) - state.at(j)).hi;
      const double length = (u.norm() + w.norm()) / 2;
      const Vec3 t = (u.normalized() + w.normalized()).normalized();
      all[j].M += angles[a].moment_vector.dot(t.cross(cell.normal)) * length / cell.area * square(t, cell.e1, cell.normal.cross(cell.e1));
    }
  }
  return all;
}

namespace {

AngleField field_of(const CosineAngle& law, const Points<3>& x, bool reversed, const std::optional<int>& normal) {
  const CosineAngle::Bending b = law.bending(x);
  AngleField f{b.angle, b.curvature, b.moment, b.moment * b.axis};
  if (reversed) f.moment_vector = -f.moment_vector;
  if (!normal) return f;
  const double sign = (b.axis[*normal] < 0) != reversed ? -1 : 1;
  f.angle *= sign, f.curvature *= sign, f.moment *= sign;
  return f;
}

void add_components(Row& row, const Vec3& v) {
  for (int c = 0; c < 3; ++c) row.emplace_back(v[c] + 0.0);                 // no negative zeros
}

// What a shape does not have is empty.
Table walls_of(const Model& model, double load_factor) {
  Table walls{{"name", "shape", "x", "y", "z", "nx", "ny", "nz", "xlo", "ylo", "zlo", "xhi", "yhi", "zhi", "lo", "hi", "radius_lo", "radius_hi", "open"}, {}};
  for (const Wall& wall : model.walls) {
    const Region r = wall_at(wall, load_factor).region.rounded();
    const bool block = r.shape == Shape::block, along = r.shape == Shape::cylinder || r.shape == Shape::cone;
    Row row{wall.name, name_of(r.shape)};
    const auto add = [&](bool has, const Vec3& v) {
      if (has) add_components(row, v);
      else row.insert(row.end(), 3, Cell{});
    };
    add(!block, r.center), add(r.shape == Shape::plane || along, along ? Vec3(Vec3::Unit(r.axis)) : r.normal);
    add(block, r.lo), add(block, r.hi);
    for (const double end : {r.axial_lo, r.axial_hi}) row.push_back(along ? Cell(end) : Cell{});
    for (const double radius : {r.radius_lo, r.radius_hi})
      row.push_back(r.shape == Shape::cone ? Cell(radius) : along || r.shape == Shape::sphere ? Cell(r.radius) : Cell{});
    row.emplace_back(fmt::format("{}", fmt::join(r.open_faces(), " ")));
    walls.rows.push_back(std::move(row));
  }
  return walls;
}

}  // namespace

std::vector<BondField> bond_fields(const Model& model, const State& state) {
  const std::vector<HarmonicBond> laws = bond_laws(model, state.load_factor);
  std::vector<BondField> fields;
  fields.reserve(laws.size());
  for (std::size_t b = 0; b < laws.size(); ++b) {
    const Points<2> x = points<2>(state, model.bonds[b].particles);
    fields.push_back({x.edge(0, 1).hi.norm(), laws[b].strain(x), laws[b].tension(x)});
  }
  return fields;
}

std::vector<AngleField> angle_fields(const Model& model, const State& state) {
  const std::vector<CosineAngle> laws = angle_laws(model, state.load_factor);
  std::vector<AngleField> fields;
  fields.reserve(laws.size());
  for (std::size_t a = 0; a < laws.size(); ++a) {
    const std::array<int, 3> sites = angle_sites(model, model.angles[a]);
    fields.push_back(field_of(laws[a], points<3>(state, sites), sites != model.angles[a].particles, model.plane_normal));
  }
  return fields;
}

Field contact_forces(const Model& model, const std::vector<Touch>& touches) {
  Field forces = Field::Zero(3, entities(model));
  for (const Touch& t : touches) {
    forces.col(t.particle) += t.force;
    if (t.other >= 0) forces.col(t.other) -= t.force;
  }
  return forces;
}

Fields fields_at(Energy& energy, const State& state, const std::vector<Touch>& touches) {
  const Model& model = energy.model();
  Fields fields{bond_fields(model, state), angle_fields(model, state), energy.shares(state), contact_forces(model, touches), {}};
  fields.sheets = stress_resultants(model, state, fields.bonds, fields.angles);
  return fields;
}

void write_fields(const std::function<std::string(const char* end)>& file, const Model& model, const State& state, const Fields& fields) {
  std::vector<std::string> columns{"id", "kind", "x", "y", "z", "radius", "energy", "fx", "fy", "fz"};
  if (!fields.sheets.empty()) columns.insert(columns.end(), {"N11", "N22", "N12", "M11", "M22", "M12"});
  WholeCsv particles(file(".particles.csv"), columns);
  for (int e = 0; e < entities(model); ++e) {
    const bool body = is_body(model, e);
    Row row{id_of(model, e), body ? "body" : "particle"};
    add_components(row, body ? state.bodies[e - model.particles()].position.hi : Vec3(state.position.col(e)));
    row.insert(row.end(), {size_of(model, e) / 2, fields.energy[e]});
    add_components(row, fields.contact_force.col(e));
    if (!body && !fields.sheets.empty() && fields.sheets[e].known)
      for (const Vec3& resultant : {fields.sheets[e].N, fields.sheets[e].M}) add_components(row, resultant);
    row.resize(columns.size());
    particles.add(row);
  }
  particles.keep();

  if (!fields.bonds.empty()) {
    WholeCsv bonds(file(".bonds.csv"), {"first", "second", "length", "strain", "tension"});
    for (std::size_t b = 0; b < fields.bonds.size(); ++b) {
      const auto& p = model.bonds[b].particles;
      const BondField& f = fields.bonds[b];
      bonds.add({model.id[p[0]], model.id[p[1]], f.length, f.strain, f.tension});
    }
    bonds.keep();
  }
  if (!fields.angles.empty()) {
    WholeCsv angles(file(".angles.csv"), {"first", "middle", "third", "turn", "curvature", "moment", "mx", "my", "mz"});
    for (std::size_t a = 0; a < fields.angles.size(); ++a) {
      const auto& p = model.angles[a].particles;
      const AngleField& f = fields.angles[a];
      Row row{model.id[p[0]], model.id[p[1]], model.id[p[2]], f.angle, f.curvature, f.moment};
      add_components(row, f.moment_vector);
      angles.add(row);
    }
    angles.keep();
  }
  if (!model.walls.empty()) write_csv(file(".walls.csv"), walls_of(model, state.load_factor));
}

}  // namespace elamin
