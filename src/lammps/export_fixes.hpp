#pragma once
// What acts in a stage as lines of a LAMMPS script: loads, weight, walls, drag.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// A `fix`: its id without a number, the particles it is for, and what stands behind the group. Lines before it define its variables,
/// and of a wall its region.
struct ExportFix {
  std::string name;
  std::vector<int> particles;
  std::string text;
  std::vector<std::string> variables, regions;
  std::string means;                        // a comment
  std::vector<std::pair<std::string, std::string>> files = {};   // that the variables read: names and texts
};

/// A name with letters, digits and _ alone, as LAMMPS wants them.
std::string lammps_name(std::string name);

/// The shortest number that reads back to the same double.
std::string lammps_number(double value);

/// "hertz/material 2E_eff γ 0 tangential linear_nohistory x μ damping …" of pair_coeff, and of wall/gran/region: with ν = 0 their
/// moduli are E_eff = E/2 in every version; others, of 2021, have E/(2(1 − ν)) at walls.
std::string granular_law(double effective_modulus, const ContactDamping& damping);

/// Everything but supports that acts while the load factor goes from one value to another; what LAMMPS cannot say is told in `refused`.
/// stem: of the names of files.
std::vector<ExportFix> export_fixes(const Model& model, double from, double to, const std::string& stem, std::vector<std::string>& refused);

}  // namespace elamin
