#pragma once
// A LAMMPS input script as part of a problem file.
#include "input/document.hpp"

namespace elamin {

/// If [lammps] has `input`: the tables that `elamin import` makes of that script come before those of the file. What both have is the
/// file's: a key of the top or of a table such as [path]. With `particles_only`, which is true from then on, no tables come. Nothing is
/// written: the script's particles are in document.script. Does nothing the second time. Throws InputError with the script's mistakes, or
/// if it gives not one problem but several.
void take_lammps_input(Document& document);

}  // namespace elamin
