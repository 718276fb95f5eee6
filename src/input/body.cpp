#include "core/find.hpp"
#include "input/parts.hpp"

#include "input/stiffness.hpp"
#include "lammps/bodies.hpp"
#include "model/entities.hpp"
#include "model/rigid_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace elamin {

namespace {

constexpr Word<BodyShape> body_words[]{{"sphere", BodyShape::sphere}, {"rod", BodyShape::rod},   {"tetrahedron", BodyShape::tetrahedron},
                                       {"cube", BodyShape::cube},     {"box", BodyShape::box},   {"mesh", BodyShape::mesh},
                                       {"molecule", BodyShape::molecule}};

}  // namespace

void describe(Keys& keys, TurnTable& t) {
  keys.about("A rotation.");
  keys.must("axis", t.axis, "its axis, of any length but zero");
  keys.must("angle", t.angle, "its angle [degrees]");
}

void describe(Keys& keys, BodyTable& t) {
  keys.about("A rigid body: a core, rounded by a ball. Lengths are of the core, without the rounding.");
  keys.name("name", t.name, "its name, which is a group too");
  if (!keys.must_word("shape", t.shape, body_words, "of its core")) return keys.skip_the_rest();   // other keys belong to other shapes
  const auto edge = [&] { keys.must("edge", t.edge, "of a tetrahedron or a cube [length]", range::positive); };
  keys.either("shape", {{{"sphere"}, "a sphere, which has rounding_diameter", t.shape == BodyShape::sphere, [] {}},
                        {{"rod"}, "a rod", t.shape == BodyShape::rod,
                         [&] { keys.must("length", t.length, "of a rod [length]", range::positive); }},
                        {{"tetrahedron"}, "a tetrahedron", t.shape == BodyShape::tetrahedron, edge},
                        {{"cube"}, "a cube", t.shape == BodyShape::cube, edge},
                        {{"box"}, "a box", t.shape == BodyShape::box,
                         [&] { keys.must("size", t.size, "the sides of a box [length]", range::positive); }},
                        {{"mesh"}, "a mesh", t.shape == BodyShape::mesh, [&] {
                           keys.must("vertices", t.vertices, "of a mesh");
                           keys.may("faces", t.faces, "of a mesh: indices of vertices from 1, counter-clockwise seen from outside", range::id);
                           keys.may("edges", t.edges, "of a mesh: pairs of vertices; by default those of the faces", range::id);
                         }},
                        {{"molecule"}, "a molecule, whose file has them", t.shape == BodyShape::molecule,
                         [&] { keys.file("molecule", t.molecule, "LAMMPS's molecule file of one body"); }}});
  keys.may("mass", t.mass, "[mass]; of a density it follows", range::positive);
  keys.either("shape", {{{"sphere", "rod", "tetrahedron", "cube", "box", "mesh"}, "a body", t.shape != BodyShape::molecule, [&] {
                           keys.must("rounding_diameter", t.rounding_diameter, "of the ball that rounds the core [length]", range::positive);
                           keys.may("density", t.density, "[mass/length³]", range::positive);
                           keys.may("inertia", t.inertia,
                                    "with mass, about the centre of mass: ixx, iyy, izz, ixy, ixz, iyz; by default of a uniform solid");
                         }},
                        {{"molecule"}, "a molecule, whose file has it", t.shape == BodyShape::molecule, [] {}}});
  keys.may("from_stage", t.from_stage, "the stage it is there from, with what it carries; by default from the start");
  keys.may("position", t.position, "of the origin of the core's frame");
  keys.table("rotation", t.rotation);
  keys.at_most_one({"mass", "density"});
  keys.with({"inertia"}, {"mass"}, "since of a density it follows");
}

void describe(Keys& keys, GlueTable& t) {
  keys.about("Particles that a body carries.");
  keys.must("group", t.group, "the particles");
  keys.must("body", t.body, "a [[body]], or a group of one");
}

namespace {

Mat3 inertia_of(const std::vector<double>& i) {
  Mat3 m;
  m << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return m;
}

void check_mesh(BodyTable& b, Mistakes& mistakes) {
  if (b.vertices.size() > 2 && b.faces.empty() && !b.place.keys.count("faces"))
    mistakes.add(b.place, "faces", "is missing; it must be a list of faces, each a list of the indices of its vertices from 1");
  if (!b.edges) return;
  for (const std::vector<int>& e : *b.edges)
    if (e.size() != 2) return mistakes.add(b.place, "edges", fmt::format("must be pairs of vertices; one has {}", e.size()));
}

void check_body(BodyTable& b, Mistakes& mistakes) {
  check(b.rotation, b.place, mistakes);
  if (b.place.broken) return;
  if (b.shape == BodyShape::mesh) check_mesh(b, mistakes);
  if (!b.inertia) return;
  const std::vector<double>& i = *b.inertia;
  if (i.size() != 6)
    return mistakes.add(b.place, "inertia", fmt::format("must be six numbers [ixx, iyy, izz, ixy, ixz, iyz], is a list of {}", i.size()));
  if (const std::string wrong = wrong_inertia(inertia_of(i)); !wrong.empty()) mistakes.add(b.place, "inertia", wrong);
}

}  // namespace

void check(std::optional<TurnTable>& turn, TablePlace& of, Mistakes& mistakes) {
  if (turn) check_direction(turn->place, "axis", turn->axis, mistakes);
  of.broken = of.broken || (turn && turn->place.broken);
}

void check_bodies(Problem& problem, Names& names, Mistakes& mistakes) {
  for (BodyTable& b : problem.bodies) {
    names.add(b.place, b.name);
    check_body(b, mistakes);
  }
}

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
  if (table.rotation) b.pose.rotation = quaternion(table.rotation->vector());
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
    const Members* group = groups.find(table.place, "group", table.group);
    const Members* body = groups.find(table.place, "body", table.body);
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
        mistakes.add(table.place, "group",
                     fmt::format("{} is glued by {} already; once is enough", called(model, p), named(first->second->place)));
        break;
      }
      const ExactVector apart = model.start.at(p) - pose.position;
      model.glued.push_back({p, b, pose.rotation.conjugate() * Vec3(apart.hi + apart.lo)});
    }
  }
  std::sort(model.glued.begin(), model.glued.end(), [](const Glued& a, const Glued& b) { return a.particle < b.particle; });
  return whole;
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
        else if constexpr (requires { table.loop; }) return std::vector<std::string>{table.loop ? *table.loop : table.sheet.value_or("")};
        else return std::vector<std::string>{table.group};
      }();
      if (table.place.broken || !contains(names, name)) continue;
      return mistakes.add(table.place, key, fmt::format("{} is carried by {}, {}", called(model, *glued),
                                                        called(model, model.particles() + model.glued[carrier[*glued]].body), what));
    }
  };
  for (const Support& s : model.supports)
    refuse(problem.supports, s.group, s.particles, "group", "which moves it; hold the body instead");
  for (const Pressure& p : model.pressures)
    refuse(problem.pressures, p.of, p.particles, p.triangles.empty() ? "loop" : "sheet", "where a pressure does not act; leave out the glue or the pressure");
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
      const auto name = [&](int body) { return called(model, model.particles() + body); };
      return mistakes.add(table->place, "between",
                          fmt::format("no [[contact]] with law \"rounded\" is between {} and {}; give one, with k_n = 0 if they feel "
                                      "nothing of each other", name(std::min(a, b)), name(std::max(a, b))));
    }
}

}  // namespace

void check_bodies_built(const Problem& problem, const Model& model, Mistakes& mistakes) {
  check_glued(problem, model, mistakes);
  check_spoken_of(problem, model, mistakes);
}

}  // namespace elamin
