#include "energy/body_neighbours.hpp"

#include <algorithm>

namespace elamin {

namespace {
constexpr double skin_of_cutoff = 0.2;
}

BodyNeighbours::BodyNeighbours(const Model& model) : rules_(model) {
  double smallest = infinity;
  for (int e = 0; e < rules_.entities(); ++e)
    if (rules_.cutoff_radius(e) > 0) smallest = std::min(smallest, rules_.cutoff_radius(e));
  if (rules_.any()) skin_ = skin_of_cutoff * smallest;
}

bool BodyNeighbours::covers(const State& state) const {
  if (!rules_.any()) return true;
  if (listed_.cols() != rules_.entities()) return false;
  for (int e = 0; e < rules_.entities(); ++e)
    if (rules_.cutoff_radius(e) > 0 && !((rules_.position(e, state) - listed_.col(e)).squaredNorm() <= skin_ * skin_ / 4)) return false;
  return true;
}

bool BodyNeighbours::refresh(const State& state) {
  if (!rules_.any()) return false;
  const int n = rules_.entities();
  listed_.resize(3, n);
  std::vector<double> radii(n, 0.0);
  for (int e = 0; e < n; ++e) {
    listed_.col(e) = rules_.position(e, state);
    if (rules_.cutoff_radius(e) > 0) radii[e] = rules_.cutoff_radius(e) + skin_ / 2;
  }
  std::vector<IndexPair> now = near_pairs(listed_, radii, [&](int i, int j) { return rules_.table(i, j) >= 0; });
  if (std::includes(pairs_.begin(), pairs_.end(), now.begin(), now.end())) return false;
  pairs_ = std::move(now);
  return true;
}

}  // namespace elamin
