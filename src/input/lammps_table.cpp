#include "input/lammps_table.hpp"

namespace elamin {

void describe(Keys& keys, LammpsTable& t) {
  keys.about("Particles, bonds, angles (with their coefficients) and bodies from LAMMPS data files. Atom type 2 is the group \"type2\"; ids are "
             "LAMMPS's own.");
  keys.may_file("data", t.data, "the data file");
  keys.may_file("bodies", t.bodies, "a data file of bodies beside it");
  keys.may("atom_style", t.atom_style, "LAMMPS's, where the comment behind \"Atoms\" does not say it");
  keys.one_at_least({"data", "bodies"}, "give data = \"case.data\"");
}

}  // namespace elamin
