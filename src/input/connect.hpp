#pragma once
// Bonds that join structures, and what is removed.
#include "input/keys.hpp"


namespace elamin {

/// Bonds between the particles of two groups that are near each other, and angles over these bonds.
struct ConnectTable {
  TablePlace place;
  std::string from_stage;
  std::array<std::string, 2> between;
  double within = 0;
  std::optional<int> bonds_per_particle;
  double bond_stiffness = 0;
  std::optional<double> rest_length, angle_stiffness;
  Rest rest{true, 180};
  bool operator==(const ConnectTable&) const = default;
};

/// What is gone from a stage on.
struct RemoveTable {
  enum class What { particles, bonds, angles };
  TablePlace place;
  std::string group, from_stage;
  What what = What::particles;
  bool operator==(const RemoveTable&) const = default;
};

void describe(Keys& keys, ConnectTable& t);
void describe(Keys& keys, RemoveTable& t);

}  // namespace elamin
