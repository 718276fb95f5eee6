#pragma once
// Rigid walls.
#include "input/contact.hpp"
#include "input/region.hpp"


namespace elamin {

struct WallTable {
  TablePlace place;
  std::string name, group = "all";
  Region region;
  bool inside = true;
  std::optional<double> youngs_modulus, poissons_ratio, effective_modulus;
  std::optional<double> k_n, c_t;
  double k_na = 0, cutoff = 0, c_n = 0;
  bool lammps = false, curved = false;
  Vec3 displacement = Vec3::Zero();
  double radius_change = 0;
  bool hard = false;
  DampingKeys damping;
  std::string from_stage;
  bool operator==(const WallTable&) const = default;
};

void describe(Keys& keys, WallTable& t);

}  // namespace elamin
