#include "lammps/reading.hpp"

#include "core/find.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

namespace elamin {

std::string owner_of(const std::string& section) {
  static const std::map<std::string, std::string> owners{
      {"Bond Coeffs", "Bonds"},                    {"Angle Coeffs", "Angles"},
      {"Dihedral Coeffs", "Dihedrals"},            {"Improper Coeffs", "Impropers"},
      {"MiddleBondTorsion Coeffs", "Dihedrals"},   {"EndBondTorsion Coeffs", "Dihedrals"},
      {"AngleTorsion Coeffs", "Dihedrals"},        {"AngleAngleTorsion Coeffs", "Dihedrals"},
      {"BondBond13 Coeffs", "Dihedrals"},          {"AngleAngle Coeffs", "Impropers"},
      {"Dihedral Type Labels", "Dihedrals"},       {"Improper Type Labels", "Impropers"}};
  const auto found = owners.find(section);
  return found == owners.end() ? section : found->second;
}

bool LammpsReading::ignores(const std::string& section) const {
  const auto named = [&](const std::string& name) { return contains(ignore, name); };
  return named(section) || named(owner_of(section));
}

std::string other_format(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return "";
  std::ifstream in(file, std::ios::binary);
  std::string start(64, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  const auto begins = [&](const char* with) { return start.starts_with(with); };
  if (begins("LammpS RestartT"))
    return "is a LAMMPS restart file; `lmp -restart2data FILE case.data`, or read_restart and write_data in a script, makes a data file "
           "of it";
  if (begins("ITEM:"))
    return "is a LAMMPS dump file, which knows neither bonds nor coefficients; write_data in the script writes a data file (of a run that "
           "is over: read_restart or read_data, then read_dump and write_data)";
  if (begins("\x1f\x8b")) return "is compressed; unpack it with gunzip";
  return "";
}

}  // namespace elamin
