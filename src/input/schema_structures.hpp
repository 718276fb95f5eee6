#pragma once
// Keys of what is made of particles.
#include "input/schema_words.hpp"

#include <vector>

namespace elamin {

template <class IO> void describe(IO& io, LammpsTable& t) {
  bool beside = true;
  if constexpr (IO::reading) beside = io.has("bodies");
  beside ? io.may_file("data", t.data) : io.file("data", t.data);
  io.may_file("bodies", t.bodies);
  io.may("atom_style", t.atom_style);
}

/// What every glued structure may say of its stiffnesses.
template <class IO, class Table> void describe_stiffness(IO& io, Table& t) {
  io.may("thickness", t.thickness, range::positive);
  io.may("youngs_modulus", t.youngs_modulus, range::positive);
  io.may("density", t.density, range::positive);
  io.may("bond_stiffness", t.bond_stiffness, range::positive);
  io.may("angle_stiffness", t.angle_stiffness, range::positive);
  io.may("rest_length", t.rest_length, range::positive);
  io.may("rest", t.rest, range::degrees);
}

/// What a row of particles may say besides: EA and EI instead of a section.
template <class IO, class Table> void describe_row_stiffness(IO& io, Table& t) {
  io.may("axial_stiffness", t.axial_stiffness, range::positive);
  io.may("bending_stiffness", t.bending_stiffness, range::positive);
}

template <class IO> void describe(IO& io, BeamTable& t) {
  io.name("name", t.name);
  io.may("from_stage", t.from_stage);
  io.word("section", t.section, section_words);
  io.must("particles", t.particles, Range{2, most_particles});
  io.may("from", t.from);
  io.may("to", t.to);
  io.may("rise", t.rise);
  io.may("angle", t.angle, Range{0, 359, true});
  io.may("toward", t.toward);
  io.word("profile", t.profile, profile_words);
  io.may("through", t.through);
  io.word("clamped", t.clamped, clamped_words);
  io.may("center", t.center);
  io.may("axis", t.axis);
  io.may("spacing", t.spacing, range::positive);
  io.must("diameter", t.diameter, range::positive);
  describe_stiffness(io, t);
  describe_row_stiffness(io, t);
}

template <class IO> void describe(IO& io, LoopTable& t) {
  io.name("name", t.name);
  io.may("from_stage", t.from_stage);
  io.word("section", t.section, section_words);
  io.must("particles", t.particles, Range{3, most_particles});
  io.may("center", t.center);
  io.may("normal", t.normal);
  io.must("radius", t.radius, range::positive);
  io.must("diameter", t.diameter, range::positive);
  describe_stiffness(io, t);
  describe_row_stiffness(io, t);
}

template <class IO> void describe(IO& io, SheetTable& t) {
  io.name("name", t.name);
  io.may("from_stage", t.from_stage);
  if (!io.word("shape", t.shape, sheet_words)) return io.skip_the_rest();   // other keys belong to other shapes
  switch (t.shape) {
    case SheetShape::rectangle:
      io.must("size", t.size, range::positive);
      for (const char* key : {"radius", "height"}) io.foreign(key, "a rectangle, which has size");
      break;
    case SheetShape::circle:
      io.must("radius", t.radius, range::positive);
      for (const char* key : {"size", "height"}) io.foreign(key, "a circle, which has radius");
      break;
    case SheetShape::cylinder:
      io.must("radius", t.radius, range::positive);
      io.must("height", t.height, range::positive);
      io.foreign("size", "a cylinder, which has radius and height");
  }
  io.may("center", t.center);
  io.may("normal", t.normal);
  io.may("lattice_angle", t.lattice_angle);
  io.must("spacing", t.spacing, range::positive);
  io.may("diameter", t.diameter, range::positive);
  describe_stiffness(io, t);
}

template <class IO> void describe(IO& io, GrainsTable& t) {
  io.name("name", t.name);
  io.may("from_stage", t.from_stage);
  io.may("positions", t.positions);
  io.may_file("file", t.file);
  io.may("diameter", t.diameter, range::positive);
  io.may("density", t.density, range::positive);
}

template <class IO> void describe(IO& io, TurnTable& t) {
  io.must("axis", t.axis);
  io.must("angle", t.angle);
}

template <class IO> void describe(IO& io, BodyTable& t) {
  io.name("name", t.name);
  if (!io.must_word("shape", t.shape, body_words)) return io.skip_the_rest();   // other keys belong to other shapes
  std::vector<const char*> others{"length", "edge", "size", "vertices", "faces", "edges", "molecule"};
  const auto has = [&](std::initializer_list<const char*> keys, const std::string& what) {
    for (const std::string key : keys) std::erase_if(others, [&](const char* other) { return key == other; });
    for (const char* other : others) io.foreign(other, what);
  };
  switch (t.shape) {
    case BodyShape::sphere: has({}, "a sphere, which has rounding_diameter"); break;
    case BodyShape::rod:
      io.must("length", t.length, range::positive);
      has({"length"}, "a rod, which has length");
      break;
    case BodyShape::tetrahedron:
    case BodyShape::cube:
      io.must("edge", t.edge, range::positive);
      has({"edge"}, t.shape == BodyShape::cube ? "a cube, which has edge" : "a tetrahedron, which has edge");
      break;
    case BodyShape::box:
      io.must("size", t.size, range::positive);
      has({"size"}, "a box, which has size");
      break;
    case BodyShape::mesh:
      io.must("vertices", t.vertices);
      io.may("faces", t.faces, range::id);
      io.may("edges", t.edges, range::id);
      has({"vertices", "faces", "edges"}, "a mesh, which has vertices, faces and edges");
      break;
    case BodyShape::molecule:
      io.file("molecule", t.molecule);
      has({"molecule"}, "a molecule, whose file has them");
  }
  io.may("mass", t.mass, range::positive);
  if (t.shape == BodyShape::molecule)
    for (const char* key : {"rounding_diameter", "density", "inertia"}) io.foreign(key, "a molecule, whose file has it");
  else {
    io.must("rounding_diameter", t.rounding_diameter, range::positive);
    io.may("density", t.density, range::positive);
    io.may("inertia", t.inertia);
  }
  io.may("position", t.position);
  io.table("rotation", t.rotation);
}

template <class IO> void describe(IO& io, GlueTable& t) {
  io.must("group", t.group);
  io.must("body", t.body);
}

template <class IO> void describe(IO& io, RemoveTable& t) {
  io.must("group", t.group);
  io.must("from_stage", t.from_stage);
  io.word("what", t.what, remove_words);
}

template <class IO> void describe(IO& io, ConnectTable& t) {
  io.must("between", t.between);
  io.may("from_stage", t.from_stage);
  io.must("within", t.within, range::positive);
  io.may("bonds_per_particle", t.bonds_per_particle, range::count);
  io.must("bond_stiffness", t.bond_stiffness, range::positive);
  io.may("rest_length", t.rest_length, range::positive);
  io.may("angle_stiffness", t.angle_stiffness, range::positive);
  io.may("rest", t.rest, range::degrees);
}

}  // namespace elamin
