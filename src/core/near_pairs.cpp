#include "core/near_pairs.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace elamin {

namespace {

using Cell = std::array<std::int64_t, 3>;

constexpr double wider = 1 + 1.0 / 64;           // cells: quotients of coordinates are rounded, by less than that up to 2⁴⁶ cells

// Balls of about one size, sorted by their cells: those of three cells in a row along z stand side by side.
struct Grid {
  double cell = 0;                                              // no less than twice the largest radius: neighbours lie in 27 cells
  std::vector<std::pair<Cell, int>> balls;

  Cell cell_of(const Vec3& x) const {
    Cell c;
    for (int k = 0; k < 3; ++k) c[k] = static_cast<std::int64_t>(std::clamp(std::floor(x[k] / cell), -9e18, 9e18));
    return c;
  }
};

}  // namespace

std::vector<IndexPair> near_pairs(const Field& centers, const std::vector<double>& radii, const std::function<bool(int, int)>& wanted) {
  const int n = static_cast<int>(centers.cols());
  std::map<int, Grid> grids;                                    // by the power of two of the radius
  for (int i = 0; i < n; ++i) {
    if (!(radii[i] > 0)) continue;
    Grid& grid = grids[std::ilogb(radii[i])];
    grid.balls.push_back({{}, i});
    grid.cell = std::max(grid.cell, wider * 2 * radii[i]);
  }
  for (auto& [power, grid] : grids) {
    for (auto& [cell, i] : grid.balls) cell = grid.cell_of(centers.col(i));
    std::sort(grid.balls.begin(), grid.balls.end());
  }
  // The smaller one of two looks for the larger one; of one size, each for the other, once.
  std::vector<std::vector<int>> partners(n);
  parallel_for(n, 1000, [&](std::int64_t at) {
    const int i = static_cast<int>(at);
    if (!(radii[i] > 0)) return;
    const Vec3 x = centers.col(i);
    const int own = std::ilogb(radii[i]);
    for (auto level = grids.lower_bound(own); level != grids.end(); ++level) {
      const Grid& grid = level->second;
      const Cell middle = grid.cell_of(x);
      for (int k = 0; k < 9; ++k) {
        const Cell first{middle[0] + k / 3 - 1, middle[1] + k % 3 - 1, middle[2] - 1}, last{first[0], first[1], middle[2] + 1};
        auto ball = std::lower_bound(grid.balls.begin(), grid.balls.end(), std::pair(first, -1));
        for (; ball != grid.balls.end() && ball->first <= last; ++ball) {
          const int j = ball->second;
          if (j == i || (level->first == own && j < i)) continue;
          const double sum = radii[i] + radii[j];
          if ((centers.col(j) - x).squaredNorm() <= sum * sum && wanted(i, j)) partners[i].push_back(j);
        }
      }
    }
  });
  std::vector<IndexPair> pairs;
  for (int i = 0; i < n; ++i)
    for (const int j : partners[i]) pairs.push_back({std::min(i, j), std::max(i, j)});
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<int> points_at(const Field& places, const Field& points, double within) {
  const int n = static_cast<int>(points.cols());
  Field all(3, n + places.cols());
  all << points, places;
  std::vector<int> found(places.cols(), -1);
  for (const auto& [i, j] : near_pairs(all, std::vector<double>(all.cols(), within / 2), [n](int a, int b) { return (a < n) != (b < n); }))
    found[j - n] = i;
  return found;
}

}  // namespace elamin
