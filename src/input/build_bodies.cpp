#include "input/build_bodies.hpp"

#include "model/rigid_body.hpp"
#include "input/build_beam.hpp"
#include "input/build_structures.hpp"
#include "input/check_parts.hpp"
#include "lammps/molecule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace elamin {
namespace {

CoreMesh mesh_core(const BodyTable& table) {
  CoreMesh core;
  core.vertices = table.vertices, core.faces = table.faces;
  for (std::vector<int>& face : core.faces)
    for (int& corner : face) --corner;
  if (table.edges)
    for (const std::vector<int>& e : *table.edges) core.edges.push_back({e[0] - 1, e[1] - 1});
  return core;
}

CoreMesh core_of(const BodyTable& table) {
  switch (table.shape) {
    case BodyShape::rod: return rod_core(table.length);
    case BodyShape::tetrahedron: return tetrahedron_core(table.edge);
    case BodyShape::cube: return cube_core(table.edge);
    case BodyShape::box: return box_core(table.size);
    case BodyShape::mesh: return mesh_core(table);
    default: return point_core();
  }
}

Mat3 inertia_of(const std::vector<double>& i) {
  Mat3 m;
  m << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return m;
}

/// The body that a molecule file describes, its centre of mass at the position.
std::optional<RigidBody> molecule(const BodyTable& table, RigidBody b, Mistakes& mistakes) {
  try {
    LammpsMolecule file = read_molecule(table.molecule);
    b.core = std::move(file.form.core), b.radius = file.form.diameter / 2;
    b.inertia = file.form.inertia, b.centered = true;
    b.mass = table.mass.value_or(file.mass);
    if (!table.mass || file.mass == 0) return b;
    mistakes.add(table.place, "mass", "stands in the molecule file; leave it out");
  } catch (const InputError& e) {
    mistakes.add(e.mistakes());
  }
  return std::nullopt;
}

std::optional<RigidBody> built(const BodyTable& table, Mistakes& mistakes) {
  RigidBody b;
  b.name = table.name;
  b.pose.position = {table.position, Vec3::Zero()};
  if (table.rotation) b.pose.rotation = turn(table.rotation->vector());
  if (table.shape == BodyShape::molecule) return molecule(table, std::move(b), mistakes);
  b.core = core_of(table), b.radius = *table.rounding_diameter / 2;
  const char* key = table.shape != BodyShape::mesh ? "shape" : table.faces.empty() ? "vertices" : "faces";
  const std::vector<std::string> wrong = elamin::mistakes(b.core, b.radius, 1);
  for (const std::string& what : wrong) mistakes.add(table.place, key, what);
  if (!wrong.empty()) return std::nullopt;
  if (lost(table.place, "rounding_diameter", 2 * b.radius, table.position.cwiseAbs().maxCoeff(), mistakes)) return std::nullopt;
  b.density = table.density.value_or(0), b.mass = table.mass.value_or(0);
  if (table.inertia) b.inertia = inertia_of(*table.inertia);
  return b;
}

}  // namespace

void add_bodies(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes) {
  std::vector<RigidBody> bodies;
  std::vector<const TablePlace*> places;
  for (const BodyTable& table : problem.bodies) {
    std::optional<RigidBody> one;
    if (!table.place.broken) one = built(table, mistakes);
    if (one) bodies.push_back(std::move(*one)), places.push_back(&table.place);
    else left_out.push_back(table.name);
  }
  const std::size_t before = model.bodies.size();
  add_bodies(model, bodies);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Body& b = model.bodies[before + k];
    const bool asked = bodies[k].density > 0 || bodies[k].mass > 0;
    if (asked && !(std::isnormal(b.mass) && b.inertia.allFinite()))
      mistakes.add(*places[k], fmt::format("its mass, {}, or inertia is beyond what numbers can hold", b.mass));
  }
}

bool add_glue(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  std::map<int, const GlueTable*> glued;
  for (const GlueTable& table : problem.glue) {
    const Members* group = table.place.broken ? nullptr : groups.find(table.place, "group", table.group);
    const Members* body = table.place.broken ? nullptr : groups.find(table.place, "body", table.body);
    whole = whole && group && body;
    if (!group || !body) continue;
    if (group->particles.empty())
      mistakes.add(table.place, "group", fmt::format("\"{}\" has no particle; a body carries particles", table.group));
    if (body->bodies.size() != 1 || !body->particles.empty()) {
      mistakes.add(table.place, "body", fmt::format("\"{}\" has {} particles and {} bodies; it must be one body", table.body,
                                                    body->particles.size(), body->bodies.size()));
      continue;
    }
    const int b = body->bodies.front();
    const Pose& pose = model.start.bodies[b];
    for (const int p : group->particles) {
      if (const auto [first, fresh] = glued.emplace(p, &table); !fresh) {
        mistakes.add(table.place, "group", fmt::format("particle {} is glued by {} already; once is enough", model.id[p],
                                                       named(first->second->place)));
        break;
      }
      const ExactVector apart = model.start.at(p) - pose.position;
      model.glued.push_back({p, b, pose.rotation.conjugate() * Vec3(apart.hi + apart.lo)});
    }
  }
  std::sort(model.glued.begin(), model.glued.end(), [](const Glued& a, const Glued& b) { return a.particle < b.particle; });
  return whole;
}

std::string body_name(const Model& model, int body) {
  for (const Structure& s : model.structures)
    if (body >= s.first_body && body < s.first_body + s.bodies)
      return s.kind == "body" ? fmt::format("\"{}\"", s.name) : fmt::format("body {} of \"{}\"", model.bodies[body].id, s.name);
  return fmt::format("body {}", model.bodies[body].id);
}

namespace {

/// What carries a particle: index into `glued`, or −1.
std::vector<int> carriers(const Model& model) {
  std::vector<int> of(model.particles(), -1);
  for (std::size_t k = 0; k < model.glued.size(); ++k) of[model.glued[k].particle] = static_cast<int>(k);
  return of;
}

void check_glued(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (model.glued.empty()) return;
  const std::vector<int> carrier = carriers(model);
  const auto refuse = [&](const auto& tables, const std::string& name, const std::vector<int>& particles, const char* key,
                          const char* what) {
    const auto glued = std::find_if(particles.begin(), particles.end(), [&](int p) { return carrier[p] >= 0; });
    if (glued == particles.end()) return;
    for (const auto& table : tables) {
      const auto& names = [&] {
        if constexpr (requires { table.between; }) return std::vector<std::string>(table.between.begin(), table.between.end());
        else if constexpr (requires { table.loop; }) return std::vector<std::string>{table.loop};
        else return std::vector<std::string>{table.group};
      }();
      if (table.place.broken || std::find(names.begin(), names.end(), name) == names.end()) continue;
      return mistakes.add(table.place, key, fmt::format("particle {} of \"{}\" is carried by {}, {}", model.id[*glued], name,
                                                        body_name(model, model.glued[carrier[*glued]].body), what));
    }
  };
  for (const Support& s : model.supports)
    refuse(problem.supports, s.group, s.particles, "group", "which moves it; hold the body instead");
  for (const Pressure& p : model.pressures)
    refuse(problem.pressures, p.loop, p.particles, "loop", "where a pressure does not act; leave out the glue or the pressure");
  for (const PairContact& c : model.contacts)
    for (int side = 0; c.hard && side < (c.between[0] == c.between[1] ? 1 : 2); ++side)
      refuse(problem.contacts, c.between[side], c.particles[side], "hard", "and hard contacts are of free particles; give it a modulus");
  for (const Wall& w : model.walls)
    if (w.hard) refuse(problem.walls, w.group, w.particles, "hard", "and hard contacts are of free particles; give it a modulus");
}

/// Every two bodies are spoken of, if any are. Bodies on the same sides of the same tables are alike.
void check_spoken_of(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (model.rounded.empty()) return;
  std::vector<std::vector<int>> sides(model.bodies.size());      // 2 table + side
  for (std::size_t t = 0; t < model.rounded.size(); ++t)
    for (int side = 0; side < 2; ++side)
      for (const int b : model.rounded[t].bodies[side]) sides[b].push_back(2 * static_cast<int>(t) + side);
  std::map<std::vector<int>, std::array<int, 2>> kinds;          // their first two
  for (std::size_t b = 0; b < sides.size(); ++b) {
    const auto [kind, fresh] = kinds.emplace(sides[b], std::array{static_cast<int>(b), -1});
    if (!fresh && kind->second[1] < 0) kind->second[1] = static_cast<int>(b);
  }
  const auto table = std::find_if(problem.contacts.begin(), problem.contacts.end(),
                                  [](const ContactTable& t) { return t.law == "rounded"; });
  for (auto i = kinds.begin(); i != kinds.end(); ++i)
    for (auto j = i; j != kinds.end(); ++j) {
      const int a = i->second[0], b = i == j ? i->second[1] : j->second[0];
      const auto meets = [&](int side) { return std::binary_search(j->first.begin(), j->first.end(), side ^ 1); };
      if (b < 0 || std::any_of(i->first.begin(), i->first.end(), meets)) continue;
      return mistakes.add(table->place, "between",
                          fmt::format("no [[contact]] with law \"rounded\" is between {} and {}; give one, with k_n = 0 if they feel "
                                      "nothing of each other", body_name(model, std::min(a, b)), body_name(model, std::max(a, b))));
    }
}

}  // namespace

void check_bodies_built(const Problem& problem, const Model& model, Mistakes& mistakes) {
  check_glued(problem, model, mistakes);
  check_spoken_of(problem, model, mistakes);
}

}  // namespace elamin
