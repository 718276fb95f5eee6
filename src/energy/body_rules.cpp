#include "energy/body_rules.hpp"

#include <algorithm>
#include <map>

namespace elamin {

BodyRules::BodyRules(const Model& model)
    : model_(model), any_(!model.rounded.empty() && !model.bodies.empty()), particles_(model.particles()) {
  const int n = particles_ + static_cast<int>(model.bodies.size());
  class_.assign(n, 0), cutoff_radius_.assign(n, 0.0), ball_.assign(particles_, -1);
  if (!any_) return;
  std::vector<std::vector<int>> member(n);                       // 2 table + side, ascending
  for (std::size_t t = 0; t < model.rounded.size(); ++t)
    for (int side = 0; side < 2; ++side) {
      const int m = 2 * static_cast<int>(t) + side;
      for (const int p : model.rounded[t].particles[side]) member[p].push_back(m);
      for (const int b : model.rounded[t].bodies[side]) member[particles_ + b].push_back(m);
    }
  std::map<double, int> of_radius;
  for (int e = 0; e < n; ++e) {
    if (member[e].empty()) continue;
    double cutoff = 0;
    for (const int m : member[e]) cutoff = std::max(cutoff, model.rounded[m / 2].kernel.cutoff);
    const double own = is_body(e) ? model.shapes[model.bodies[e - particles_].shape].bounding_radius() : model.diameter[e] / 2;
    cutoff_radius_[e] = own + cutoff / 2;
    if (is_body(e)) continue;
    const auto [found, fresh] = of_radius.emplace(own, static_cast<int>(balls_.size()));
    if (fresh) balls_.push_back(rounded_shape(point_core(), own));
    ball_[e] = found->second;
  }
  std::map<std::vector<int>, int> number;
  for (int e = 0; e < n; ++e) class_[e] = number.emplace(std::move(member[e]), static_cast<int>(number.size())).first->second;
  classes_ = number.size();
  tables_.assign(classes_ * classes_, -1);
  for (const auto& [a, i] : number)
    for (const auto& [b, j] : number)
      for (const int m : a)                                      // sides m of a table and its partner of the other class
        if (std::binary_search(b.begin(), b.end(), m ^ 1)) tables_[i * classes_ + j] = std::max(tables_[i * classes_ + j], m / 2);
  std::vector<int> carrier(particles_, -1);
  for (const Glued& g : model.glued) glued_.push_back({g.particle, g.body}), carrier[g.particle] = g.body;
  for (const Bond& b : model.bonds)
    for (int k = 0; k < 2; ++k)
      if (const int body = carrier[b.particles[k]]; body >= 0) glued_.push_back({b.particles[1 - k], body});
  std::sort(glued_.begin(), glued_.end());
}

int BodyRules::table(int i, int j) const {
  if (!is_body(i) && !is_body(j)) return -1;
  const int t = tables_[class_[i] * classes_ + class_[j]];
  if (t < 0 || (is_body(i) && is_body(j))) return t;
  const std::pair pair(std::min(i, j), std::max(i, j) - particles_);
  return std::binary_search(glued_.begin(), glued_.end(), pair) ? -1 : t;
}

Vec3 BodyRules::position(int e, const State& state) const {
  return is_body(e) ? state.bodies[e - particles_].position.hi : Vec3(state.position.col(e));
}

RoundedBody BodyRules::body(int e, const State& state) const {
  if (is_body(e)) return model_.body(e - particles_, state);
  return {&balls_[ball_[e]], Pose{state.at(e), Eigen::Quaterniond::Identity()}};
}

}  // namespace elamin
