#pragma once
// A right LAMMPS data file with every section, for tests that make it wrong.
#include <string>

inline const std::string small_data_file =
    "title\n"                              // 1
    "\n"
    "3 atoms\n"                            // 3
    "2 bonds\n"
    "1 angles\n"
    "1 atom types\n"                       // 6
    "1 bond types\n"
    "1 angle types\n"
    "\n"
    "0 10 xlo xhi\n"                       // 10
    "0 10 ylo yhi\n"
    "0 10 zlo zhi\n"
    "\n"
    "Bond Coeffs # harmonic\n"             // 14
    "\n"
    "1 100 1\n"                            // 16
    "\n"
    "Angle Coeffs # cosine\n"              // 18
    "\n"
    "1 5\n"                                // 20
    "\n"
    "Atoms # hybrid sphere angle\n"        // 22
    "\n"
    "1 1 0 0 1 1 800 1\n"                  // 24
    "2 1 0 0 2 1 800 1\n"
    "4 1 0 0 3 1 800 1\n"                  // 26
    "\n"
    "Velocities\n"                         // 28
    "\n"
    "1 0 0 1 0 0 0\n"                      // 30
    "2 0 0 1 0 0 0\n"
    "4 0 0 1 0 0 0\n"
    "\n"
    "Bonds\n"                              // 34
    "\n"
    "1 1 1 2\n"                            // 36
    "2 1 2 4\n"
    "\n"
    "Angles\n"                             // 39
    "\n"
    "1 1 1 2 4\n";                         // 41
