#pragma once
// A closed ring of particles: bonds between neighbours, angles between triplets, all around.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Ring {
  std::string name;
  int particles = 0;                               // at least 3
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();   // of any length but zero
  double radius = 0;                               // of the circle through the centres [length]
  double diameter = 0, density = 0;                // of the particles; density 0: not given
  double youngs_modulus = 0;                       // 0: not known
  BondType bond{};
  AngleType angle{};
};

/// Distance of neighbours on the circle, 2R sin(π/N) [length].
double chord(double radius, int particles);

/// The angle that three neighbours make, π − 2π/N [rad].
double ring_angle(int particles);

/// Appends the rings. Particle k is at center + R (cos φ e1 + sin φ e2), φ = 2πk/N, in the frame of the normal (see
/// frame_of), to about 1e-30; N bonds (k, k+1), N angles (k, k+1, k+2); ids, type, molecule, bond and angle type and
/// Structure as of a beam.
void add_loops(Model& model, const std::vector<Ring>& rings);

}  // namespace elamin
