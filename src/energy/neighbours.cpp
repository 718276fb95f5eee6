#include "energy/neighbours.hpp"

#include <algorithm>

namespace elamin {

namespace {
constexpr double skin_of_diameter = 0.3, hard_skin_of_diameter = 1;
}

Neighbours::Neighbours(const Model& model) : model_(model), rules_(model) {
  double smallest = infinity;
  for (int i = 0; i < model.particles(); ++i)
    if (rules_.cutoff_radius(i) > 0) smallest = std::min(smallest, 2 * rules_.cutoff_radius(i));
  const bool hard = std::any_of(model.contacts.begin(), model.contacts.end(), [](const PairContact& c) { return c.hard; });
  skin_ = rules_.any() ? (hard ? hard_skin_of_diameter : skin_of_diameter) * smallest : 0;
}

bool Neighbours::covers(const State& state, double within) const {
  if (!rules_.any()) return true;
  if (listed_.particles() != state.particles() || !(within <= skin_)) return false;
  const double most = (skin_ - within) / 2;                     // each of two may have come nearer by it
  for (Eigen::Index i = 0; i < state.particles(); ++i)
    if (rules_.cutoff_radius(static_cast<int>(i)) > 0 && !((state.position.col(i) - listed_.position.col(i)).squaredNorm() <= most * most))
      return false;
  for (const HardForce& h : state.hard)
    if (h.wall < 0 && !std::binary_search(pairs_[2].begin(), pairs_[2].end(), IndexPair{h.particle, h.other})) return false;
  return true;
}

bool Neighbours::refresh(const State& state) {
  if (!rules_.any()) return false;
  listed_ = state;
  std::vector<double> radii(model_.particles());
  for (int i = 0; i < model_.particles(); ++i)
    if (rules_.cutoff_radius(i) > 0) radii[i] = rules_.cutoff_radius(i) + skin_ / 2;
  const auto feel = [&](int i, int j) { return rules_.hertz(i, j) >= 0 || rules_.lj(i, j) >= 0; };
  std::array<std::vector<IndexPair>, 3> now;
  for (const IndexPair& p : near_pairs(state.position, radii, feel)) {
    const auto [i, j] = p;
    const double apart = (state.position.col(j) - state.position.col(i)).norm() - skin_;
    if (const int t = rules_.hertz(i, j); t >= 0 && apart <= (model_.diameter[i] + model_.diameter[j]) / 2)
      now[model_.contacts[t].hard ? 2 : 0].push_back(p);
    if (const int t = rules_.lj(i, j); t >= 0 && apart <= model_.contacts[t].cutoff) now[1].push_back(p);
  }
  for (const HardForce& h : state.hard)
    if (h.wall < 0) now[2].push_back({h.particle, h.other});
  std::sort(now[2].begin(), now[2].end());
  now[2].erase(std::unique(now[2].begin(), now[2].end()), now[2].end());
  bool changed = false;
  for (int law = 0; law < 3; ++law)
    changed = changed || !std::includes(pairs_[law].begin(), pairs_[law].end(), now[law].begin(), now[law].end());
  if (changed) pairs_ = std::move(now);
  return changed;
}

}  // namespace elamin
