#pragma once
// Reader of LAMMPS data files (the file of `read_data` and `write_data`): particles, bonds, angles and their
// coefficients, bodies.
#include "core/types.hpp"
#include "lammps/reading.hpp"
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// What a LAMMPS data file holds. Particles are sorted by id, which need not be contiguous; bonds and angles hold
/// particle indices from 0 and types from 0. Types of particles and molecules are LAMMPS's own numbers (types from 1).
struct LammpsData {
  std::vector<int> id, type, molecule;
  std::vector<double> diameter, density;   // 0: the atom style has none
  std::vector<double> mass;                // of every particle, from the section Masses [mass]; 0: not given there
  Field position;                          // 3 × particles [length], unwrapped with the image flags
  Field velocity;                          // 3 × particles [length/time], or 3 × 0: none
  Field angular_velocity;              // likewise [1/time]
  std::vector<BondType> bond_types;
  std::vector<AngleType> angle_types;
  std::vector<Bond> bonds;
  std::vector<Angle> angles;
  std::vector<RoundedShape> shapes;        // of the bodies, along the axes of the file; equal ones once
  std::vector<Body> bodies;                // sorted by id
  Field body_position;                     // 3 × bodies, unwrapped [length]
  Field body_velocity, angular_momentum;   // 3 × bodies, or 3 × 0: none
  struct Header {                          // the box; a million types at most
    Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();
    int atom_types = 0, bond_types = 0, angle_types = 0;
  } header;
  std::vector<std::string> notes;          // what was left out, in sentences
  std::string doubt;                       // of coefficients that write_data has rounded, "": none
};

/// Reads `file`. Its atom style is that of `how`, or where that names none, what the comment of the section says, as in
/// `Atoms # sphere`.
///
/// Atom styles: atomic, charge, sphere, bond, angle, molecular, full, body, and hybrids of them (sphere and body exclude each other),
/// whose columns are id type x y z and then every sub-style's own in their order. A file that announces bodies and names no
/// style has style body. `Atoms # hybrid` without sub-styles is `hybrid sphere angle` or `hybrid angle sphere` (8 columns, or 11 with
/// image flags), whichever all rows fit; both: a mistake. Image flags n move a particle by n box lengths.
///
/// Sections: Atoms, Velocities, Masses, Bodies (style rounded/polyhedron: see body_form), Bonds, Angles, Bond Coeffs
/// (harmonic), Angle Coeffs, Atom, Bond and Angle Type Labels, in any order; coefficients of pairs are passed over. Angle
/// styles: cosine, K with U = K (1 + cos θ); cosine/shift, Umin and θ₀ in degrees with U = −Umin/2 (1 + cos(θ − θ₀)),
/// of which the constant −Umin is left out: B = Umin/2. Without a comment behind the section's name it is cosine; lines
/// may name their style, as those of a hybrid do. A sphere's mass follows from its diameter and density; the Masses
/// then serve for nothing, as in LAMMPS. Charges are read and dropped: nothing here depends on them. Every atom of a file of
/// bodies is a body (flag 1), at its centre of mass; its velocities are v and the angular momentum L.
///
/// Throws InputError with file, line and column of up to 20 mistakes; memory never grows beyond what the file holds.
LammpsData read_lammps_data(const std::string& file, const LammpsReading& how);
inline LammpsData read_lammps_data(const std::string& file, const std::string& atom_style = "") {
  return read_lammps_data(file, LammpsReading{atom_style, {}, {}, {}});
}

/// Labels of the atom types of a file, "Atom Type Labels", in the order of the types; none where the file cannot be read.
std::vector<std::pair<std::string, int>> atom_type_labels(const std::string& file);

}  // namespace elamin
