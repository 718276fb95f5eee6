#pragma once
// Gluing what is built: bonds and angles one by one, or bonds between the near particles of two groups and angles over these.
#include "model/model.hpp"

#include <array>
#include <vector>

namespace elamin {

/// A bond or an angle that is to be made.
struct NewBond {
  std::array<int, 2> particles;
  double stiffness = 0, axial_stiffness = 0;       // K, or EA: K = EA/(2 r₀)
  double rest_length = 0;                          // 0: as built
};
struct NewAngle {
  std::array<int, 3> particles;
  double stiffness = 0;
  double rest = -1;                                // [rad]; negative: as built
};

/// Makes them: a bond type for each distinct stiffness and rest length (to 4e-15), an angle type for each distinct stiffness and rest
/// angle (to 1e-12 rad; as built within 1e-9 of π it is π).
void add_bonds(Model& model, const std::vector<NewBond>& bonds);
void add_angles(Model& model, const std::vector<NewAngle>& angles);

/// Every pair of bonds that meet in a particle, all three particles among these, at an angle of at least `least` [rad].
std::vector<std::array<int, 3>> meeting_bonds(const Model& model, const std::vector<int>& particles, double least);

struct Connection {
  std::vector<int> first, second;                  // indices of the particles of the two groups, ascending; may overlap
  double within = 0;                               // distance of centres, itself included to 1e-9 of it [length]; 0: any
  int bonds_per_particle = 0;                      // of `first`: to its nearest ones only, ties by index; 0: to all
  double bond_stiffness = 0, axial_stiffness = 0;  // K, or EA: K = EA/(2 r₀)
  double rest_length = 0;                          // 0: as built
  double angle_stiffness = 0;                      // 0: no angles
  bool as_built = true;                            // angles at rest as built
  double rest = pi;                                // else: rest angle [rad]
};

/// Bonds every particle of `first` to those of `second` that are near, but not to itself nor where a bond is already.
/// With an angle stiffness each new bond i–j has angles (i, j, k) over every k that was bonded to j before the
/// connection, and (j, i, m) over every m that was bonded to i. Types as of add_bonds and add_angles. `within` or
/// `bonds_per_particle` is given.
/// Returns the number of new bonds; −1, and nothing is changed, if that is more than 2e7 or more than 5e8 pairs had to
/// be tried.
int connect(Model& model, const Connection& connection);

}  // namespace elamin
