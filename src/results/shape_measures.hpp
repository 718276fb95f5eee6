#pragma once
// Lengths, angles and areas of groups, from places as exact as they are kept.
#include "model/model.hpp"

#include <optional>
#include <vector>

namespace elamin {

/// Where a particle is, or the centre of mass of a body (see model/entities.hpp).
ExactVector place_of(const State& state, int entity);

/// |v|, summed in one order wherever v is stored, as Eigen's stableNorm is not; without overflow.
double length_of(const Vec3& v);

/// From the mean of some places to the mean of others, of entities; neither is empty [length].
Vec3 way(const State& state, const std::vector<int>& from, const std::vector<int>& to);

/// The angle from u to v [rad]: 0 to π; counted about an axis of any length but zero, of their parts across it, −π to π.
double angle(const Vec3& u, const Vec3& v, const std::optional<Vec3>& about);

/// The same of two that are about opposite: counted about an axis 0 to 2π, so that π is nothing special.
double opening(const Vec3& u, const Vec3& v, const std::optional<Vec3>& about);

/// The largest less the smallest coordinate c of the places of entities [length].
double extent(const State& state, const std::vector<int>& entities, int c);

/// From the first to the second of two neighbours at the beginning or at the end of a row of at least two particles [length].
Vec3 end_bond(const State& state, const std::vector<int>& row, bool last);

/// The vector area inside of a closed row of particles, ½ Σ xᵢ × xᵢ₊₁: of a flat one its area along its normal [length²].
Vec3 vector_area(const State& state, const std::vector<int>& row);

}  // namespace elamin
