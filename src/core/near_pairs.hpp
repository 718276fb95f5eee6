#pragma once
// Balls that come near each other, whatever their sizes: a grid for every power of two.
#include "core/archive.hpp"
#include "core/types.hpp"

#include <functional>
#include <vector>

namespace elamin {

/// Two indices, first < second.
struct IndexPair {
  int first, second;
  auto operator<=>(const IndexPair&) const = default;
};

/// All pairs with |c_i − c_j| ≤ ρ_i + ρ_j that `wanted` keeps (called from several threads), ascending. Balls of radius 0
/// meet nobody. centers 3 × n, radii n [length]. About n log n for any mixture of sizes that does not overlap much.
/// Source: hierarchical grids, as Ogarko & Luding 2012, Comput. Phys. Commun. 183.
std::vector<IndexPair> near_pairs(const Field& centers, const std::vector<double>& radii, const std::function<bool(int, int)>& wanted);

/// For each of these places which of the points is there, to within a distance; −1: none is.
std::vector<int> points_at(const Field& places, const Field& points, double within);

}  // namespace elamin
