#pragma once
// A state of a run as films and pictures show it.
#include "dynamics/motion.hpp"
#include "lammps/state.hpp"
#include "results/fields.hpp"

namespace elamin {

/// What it refers to must outlive it.
struct Shot {
  std::int64_t step = 0;
  std::string label;                   // "": it has none
  double parameter = 0;                // the load factor, or the time of a motion
  const Model& model;                  // in force
  const State& state;
  const Fields& fields;
  const std::vector<Touch>& touches;
  std::vector<Field> modes = {};       // null vectors of an event, 3 × sites each
  const Motion* motion = nullptr;      // if it moves
};

/// Energy and contact force of particles and bodies; of what moves its velocity, all the force on it, and the energy; where there are sheets N and M.
/// What is not finite, and N and M beside sheets, is 0.
EntityColumns columns_of(const Shot& shot);

/// Those of the contacts that count as closed, as in contacts.csv: gap < 0, a hard contact that bears a force, or one that attracts; at an
/// event also what just touches.
std::vector<Touch> closed_contacts(const std::vector<Touch>& touches, const Model& model, const std::string& label);

/// One frame of an extended XYZ file: the number of particles and bodies; Properties, step, load_factor or time, label if it has one; a line each of
/// species (X), pos, id, kind (the type), molecule (of a body 0), radius (of a body the bounding one), and the columns.
std::string xyz_frame(const Shot& shot);

/// Writes the state as VTK's unstructured grid for ParaView, .vtu: XML, the numbers behind it in binary, packed by zlib, so that they are the same to the last bit. Cells by their `kind`:
///   0  particles, a vertex each        1  bonds, a line each: tension, strain       2  angles, a line of three points each: curvature, moment,
///   3  closed contacts, a vertex at    4  walls, polygons                              moment_vector
///      the point of contact each: gap, force (on the first)                        5  bodies, polygons
/// `first` and `second` are the ids of who bonds or touches; of a wall its number from 1, negative. What a kind does not have is 0. Points: id
/// (of particles and on bodies), radius (of particles), columns_of, and mode_1 … the null vectors as displacements. Of the whole: step,
/// load_factor or time, label. Throws OutputError if it cannot be written.
void write_vtu(const std::string& file, const Shot& shot);

}  // namespace elamin
