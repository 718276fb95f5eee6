#include "model/triangles.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace elamin {

std::vector<std::array<int, 3>> lattice_triangles(const Model& model, const Structure& structure, const Vec3& center, const Vec3& normal, bool tube) {
  const int first = structure.first, end = first + structure.count;
  std::vector<std::vector<int>> ahead(structure.count);          // bonded particles with larger numbers
  for (const Bond& b : model.bonds) {
    const auto [i, j] = std::minmax(b.particles[0], b.particles[1]);
    if (i >= first && j < end) ahead[i - first].push_back(j);
  }
  for (auto& list : ahead) std::sort(list.begin(), list.end());
  std::vector<std::array<int, 3>> triangles;
  const auto at = [&](int p) { return Vec3(model.start.position.col(p)); };
  for (int i = first; i < end; ++i)
    for (const int j : ahead[i - first])
      for (const int k : ahead[i - first]) {
        if (k <= j || !std::binary_search(ahead[j - first].begin(), ahead[j - first].end(), k)) continue;
        Vec3 outwards = normal;
        if (tube) {
          outwards = (at(i) + at(j) + at(k)) / 3 - center;
          outwards -= outwards.dot(normal) * normal;
        }
        const bool with = (at(j) - at(i)).cross(at(k) - at(i)).dot(outwards) > 0;
        triangles.push_back(with ? std::array{i, j, k} : std::array{i, k, j});
      }
  return triangles;
}

std::vector<std::array<int, 2>> rim_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : triangles)
    for (int s = 0; s < 3; ++s) edges.insert({t[s], t[(s + 1) % 3]});
  std::vector<std::array<int, 2>> rim;
  for (const auto& [i, j] : edges)
    if (!edges.count({j, i})) rim.push_back({i, j});
  return rim;
}

}  // namespace elamin
