#pragma once
// LAMMPS's molecule files, of one body.
#include "lammps/body.hpp"

#include <string>

namespace elamin {

struct LammpsMolecule {
  BodyForm form;                         // about the centre of mass
  double mass = 0;                       // 0: not given
};

/// Reads a molecule file (the file of LAMMPS's command `molecule`) that holds one body of style rounded/polyhedron: header
/// lines `1 atoms`, `3 M body` and perhaps `m mass`, `x y z com`, the sections Body Integers (N E F) and Body Doubles (M
/// numbers: see body_form), over any line breaks, and perhaps Coords, Types, Molecules, Diameters and Masses (id, mass). The
/// places of the atom and of the centre of mass, the type and the diameter of the atom are read and say nothing. An inertia
/// in the header must be the body's own. Throws InputError with file, line and column of all mistakes.
LammpsMolecule read_molecule(const std::string& file);

}  // namespace elamin
