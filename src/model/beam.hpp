#pragma once
// A straight row of particles: bonds between neighbours, angles between triplets.
#include "core/exact.hpp"
#include "model/model.hpp"

#include <array>
#include <string>
#include <vector>

namespace elamin {

struct StraightBeam {
  std::string name;
  ExactVector from, to;             // centres of the end particles [length]
  int particles = 0;                // at least 2
  double diameter = 0, density = 0; // of the particles; density 0: not given
  double youngs_modulus = 0;        // 0: not known
  BondType bond{};
  AngleType angle{};
};

/// The point from + (to − from) · i/n for 0 ≤ i ≤ n, to about 32 digits of the larger coordinates.
ExactVector point_between(const ExactVector& from, const ExactVector& to, int i, int n);

/// |b − a| to about 30 digits.
Exact distance(const ExactVector& a, const ExactVector& b);

/// The two ends of a row of n + 1 points with that spacing along `axis` (of any length but zero), `center` in the
/// middle.
std::array<ExactVector, 2> ends_of_row(const Vec3& center, const Vec3& axis, double spacing, int n);

/// Appends the beams: of each its particles with the next ids, a new type and molecule, a bond type and an angle type
/// of its own, n − 1 bonds, n − 2 angles, and its Structure. A chain is uniform and straight to about 1e-30 of its
/// coordinates.
void add_beams(Model& model, const std::vector<StraightBeam>& beams);

}  // namespace elamin
