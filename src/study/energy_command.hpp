#pragma once
#include "input/settings.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// `elamin energy`: energies and forces of the state that the file starts from, nothing solved.
/// Prints a table, or JSON; writes the forces −∂U/∂x of everything, held or not, plus the drag −γv of a moving state,
/// to `forces_file` if that is not empty: particles id,fx,fy,fz in id order; bodies, if there are any, to a second file that ends
/// in .bodies.csv: id,fx,fy,fz,tx,ty,tz, torques about their places. Bodies that follow LAMMPS's rules have the energy that it
/// reports, and forces with the damping of a moving state. 0, or 2 with a sentence where
/// the energy is not finite. Throws InputError as reading does.
struct EnergyOptions {
  std::string file;
  std::vector<Setting> settings;
  bool json = false;
  std::string forces_file;
  std::optional<double> load_factor;   // default: where the study starts; 1 without a path
};
int energy_command(const EnergyOptions& options);

}  // namespace elamin
