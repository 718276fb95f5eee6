#pragma once
// Gluing structures together: bonds between the near particles of two groups, angles over these bonds.
#include "model/model.hpp"

#include <vector>

namespace elamin {

struct Connection {
  std::vector<int> first, second;                  // indices of the particles of the two groups, ascending; may overlap
  double within = 0;                               // distance of centres, itself included to 1e-9 of it [length]
  int bonds_per_particle = 0;                      // of `first`: to its nearest ones only, ties by index; 0: to all
  double bond_stiffness = 0;
  double rest_length = 0;                          // 0: as built
  double angle_stiffness = 0;                      // 0: no angles
  bool as_built = true;                            // angles at rest as built
  double rest = pi;            // else: rest angle [rad]
};

/// Bonds every particle of `first` to those of `second` that are near, but not to itself nor where a bond is already.
/// With an angle stiffness each new bond i–j has angles (i, j, k) over every k that was bonded to j before the
/// connection, and (j, i, m) over every m that was bonded to i. A bond type for each distinct rest length (to 4e-15), an
/// angle type for each distinct rest angle (to 1e-12 rad; within 1e-9 of π it is π).
/// Returns the number of new bonds; −1, and nothing is changed, if that is more than 2e7 or more than 5e8 pairs had to
/// be tried.
int connect(Model& model, const Connection& connection);

}  // namespace elamin
