#pragma once
// Particles, bonds, angles and bodies from a LAMMPS data file.
#include "input/keys.hpp"


namespace elamin {

struct LammpsTable {
  TablePlace place;
  std::string data, bodies, atom_style;
  bool operator==(const LammpsTable&) const = default;
};

void describe(Keys& keys, LammpsTable& t);

}  // namespace elamin
