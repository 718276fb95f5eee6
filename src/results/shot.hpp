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

}  // namespace elamin
