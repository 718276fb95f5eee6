#pragma once
// Forces and moments per length in a sheet, from the bonds and hinges of its lattice.
#include "model/model.hpp"

#include <array>
#include <vector>

namespace elamin {

struct AngleField;
struct BondField;

/// Stress resultants at a particle of a sheet, components 11, 22, 12 in the axes of the sheet as it was built (e1, e2 of its frame; of a
/// cylinder around and along the axis), which turn with it. Lengths are those of now.
///   N   mean over the triangles of the lattice beside the particle of  N = 1/A Σ ½ T r t tᵀ, the sum over the three bonds of the triangle,
///       of which half is its; A its area, T, r and t tension, length and direction of a bond [force/length]. Negative: compression
///   M   M = 1/A Σ m ℓ t tᵀ, the sum over the hinges that the particle is the middle of; A the area of its cell, twice the mean of the
///       triangles beside it; ℓ and t length and direction of a hinge, m the part of its moment that turns the sheet towards its
///       normal [force]. Positive: the sheet bends towards the side of its normal, e1 × e2
/// In a uniform state N is the force across any line per length, whatever the strain; at edges too, whose bonds bear what is within and as
/// much beyond: n rows of particles are a strip as wide as n rows of the lattice.
struct StressResultants {
  bool known = false;          // the particle is of a sheet, with a triangle beside it
  Vec3 N = Vec3::Zero(), M = Vec3::Zero();
};

/// The largest and the smallest eigenvalue of a symmetric tensor 11, 22, 12.
std::array<double, 2> principal(const Vec3& tensor);

/// Those of every particle; empty where the model has no sheet.
std::vector<StressResultants> stress_resultants(const Model& model, const State& state, const std::vector<BondField>& bonds,
                                                const std::vector<AngleField>& angles);

}  // namespace elamin
