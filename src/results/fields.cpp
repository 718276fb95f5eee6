#include "results/fields.hpp"

#include "energy/groups.hpp"
#include "energy/wall_group.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "model/entities.hpp"

namespace elamin {
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

std::string open_faces(const Region& region) {
  static const std::array<const char*, 6> of_block{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"}, of_others{"lo", "hi", "side", "", "", ""};
  std::string open;
  for (std::size_t k = 0; k < 6; ++k)
    if (region.open[k]) open.append(open.empty() ? "" : " ").append((region.shape == Shape::block ? of_block : of_others)[k]);
  return open;
}

// What a shape does not have is empty.
Table walls_of(const Model& model, double load_factor) {
  static const std::array<const char*, 5> shapes{"plane", "block", "cylinder", "sphere", "cone"};       // as Shape
  Table walls{{"name", "shape", "x", "y", "z", "nx", "ny", "nz", "xlo", "ylo", "zlo", "xhi", "yhi", "zhi", "lo", "hi", "radius_lo", "radius_hi", "open"}, {}};
  for (const Wall& wall : model.walls) {
    const Region r = wall_at(wall, load_factor).region;
    const bool block = r.shape == Shape::block, along = r.shape == Shape::cylinder || r.shape == Shape::cone;
    Row row{wall.name, shapes[static_cast<std::size_t>(r.shape)]};
    const auto add = [&](bool has, const Vec3& v) {
      if (has) add_components(row, v);
      else row.insert(row.end(), 3, Cell{});
    };
    add(!block, r.center), add(r.shape == Shape::plane || along, along ? Vec3(Vec3::Unit(r.axis)) : r.normal);
    add(block, r.lo), add(block, r.hi);
    for (const double end : {r.axial_lo, r.axial_hi}) row.push_back(along ? Cell(end) : Cell{});
    for (const double radius : {r.radius_lo, r.radius_hi})
      row.push_back(r.shape == Shape::cone ? Cell(radius) : along || r.shape == Shape::sphere ? Cell(r.radius) : Cell{});
    row.emplace_back(open_faces(r));
    walls.rows.push_back(std::move(row));
  }
  return walls;
}

}  // namespace

std::vector<BondField> bond_fields(const Model& model, const State& state) {
  const std::vector<HarmonicBond> laws = bond_laws(model, state.load_factor);
  std::vector<BondField> fields;
  for (std::size_t b = 0; b < laws.size(); ++b) {
    const Points<2> x = points<2>(state, model.bonds[b].particles);
    fields.push_back({x.edge(0, 1).hi.norm(), laws[b].strain(x), laws[b].tension(x)});
  }
  return fields;
}

std::vector<AngleField> angle_fields(const Model& model, const State& state) {
  const std::vector<CosineAngle> laws = angle_laws(model, state.load_factor);
  std::vector<AngleField> fields;
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

std::vector<std::pair<std::string, Table>> field_tables(const Model& model, const State& state, const Fields& fields) {
  std::vector<std::pair<std::string, Table>> all;
  Table particles{{"id", "kind", "x", "y", "z", "radius", "energy", "fx", "fy", "fz"}, {}};
  if (!fields.sheets.empty()) particles.columns.insert(particles.columns.end(), {"N11", "N22", "N12", "M11", "M22", "M12"});
  for (int e = 0; e < entities(model); ++e) {
    const bool body = is_body(model, e);
    Row row{id_of(model, e), body ? "body" : "particle"};
    add_components(row, body ? state.bodies[e - model.particles()].position.hi : Vec3(state.position.col(e)));
    row.insert(row.end(), {size_of(model, e) / 2, fields.energy[e]});
    add_components(row, fields.contact_force.col(e));
    if (!body && !fields.sheets.empty() && fields.sheets[e].known)
      for (const Vec3& resultant : {fields.sheets[e].N, fields.sheets[e].M}) add_components(row, resultant);
    row.resize(particles.columns.size());
    particles.rows.push_back(std::move(row));
  }
  all.emplace_back(".particles.csv", std::move(particles));

  Table bonds{{"first", "second", "length", "strain", "tension"}, {}};
  for (std::size_t b = 0; b < fields.bonds.size(); ++b) {
    const auto& p = model.bonds[b].particles;
    const BondField& f = fields.bonds[b];
    bonds.rows.push_back({model.id[p[0]], model.id[p[1]], f.length, f.strain, f.tension});
  }
  if (!bonds.rows.empty()) all.emplace_back(".bonds.csv", std::move(bonds));

  Table angles{{"first", "middle", "third", "turn", "curvature", "moment", "mx", "my", "mz"}, {}};
  for (std::size_t a = 0; a < fields.angles.size(); ++a) {
    const auto& p = model.angles[a].particles;
    const AngleField& f = fields.angles[a];
    Row row{model.id[p[0]], model.id[p[1]], model.id[p[2]], f.angle, f.curvature, f.moment};
    add_components(row, f.moment_vector);
    angles.rows.push_back(std::move(row));
  }
  if (!angles.rows.empty()) all.emplace_back(".angles.csv", std::move(angles));
  if (!model.walls.empty()) all.emplace_back(".walls.csv", walls_of(model, state.load_factor));
  return all;
}

}  // namespace elamin
