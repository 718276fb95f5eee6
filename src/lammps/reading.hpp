#pragma once
// How a LAMMPS data file is to be read where it does not say so itself.
#include <string>
#include <vector>

namespace elamin {

struct LammpsReading {
  std::string atom_style;                  // LAMMPS's, such as "hybrid sphere angle"; "": what the comment behind "Atoms" says
  std::vector<std::string> ignore;         // sections that are passed over, such as "Dihedrals", and with them their coefficients
  /// Of every type, instead of those in the file, unless empty: K and r₀; B, and where it is not straight θ₀ in degrees.
  std::vector<std::vector<double>> bond_coefficients, angle_coefficients;
  bool coefficients_may_lack = false;      // of types that have bonds or angles: they are given elsewhere
  const std::string* text = nullptr;       // what the file holds, where there is none on the disk

  bool ignores(const std::string& section) const;
};

/// The section whose rows a section of coefficients belongs to: "Dihedrals" of "Dihedral Coeffs"; else its own name.
std::string owner_of(const std::string& section);

/// Why a file is no LAMMPS data file but something else of LAMMPS's, with the remedy; "": it does not look like that.
std::string other_format(const std::string& file);

}  // namespace elamin
