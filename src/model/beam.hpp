#pragma once
// A row of particles, straight or along a line of any shape: bonds between neighbours, angles between triplets.
#include "model/centerline.hpp"
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Beam {
  std::string name;
  std::vector<ExactVector> centers; // at least 2
  double diameter = 0, density = 0; // of the particles; density 0: not given
  double youngs_modulus = 0;        // 0: not known
  BondType bond{};
  AngleType angle{};
  bool as_built = false;            // every angle is at rest as it is built, instead of angle.rest
  std::vector<BondType> bonds{};    // of each bond, where they are not all `bond`: those of one rest length have one stiffness
  Clamped clamped{};                // ends whose outermost angle is twice as stiff: half a bond's length bends there
};

/// Appends the beams: of each its particles with the next ids, a new type and molecule, a bond type and an angle type
/// of its own (one for each bond or angle that is different), n − 1 bonds, n − 2 angles, none of zero stiffness, and its Structure.
void add_beams(Model& model, const std::vector<Beam>& beams);

}  // namespace elamin
