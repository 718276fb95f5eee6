#include "energy/wall_group.hpp"

namespace elamin {

namespace {
constexpr std::int64_t touches_per_thread = 500;
}

WallContact wall_at(const Wall& wall, double load_factor) {
  const double part = wall.scaling.at(load_factor);
  return {wall.region.moved_exactly(two_product(part, wall.displacement), part * wall.radius_change), wall.inside,
          wall.hard ? 0.0 : wall.effective_modulus, wall.curved};
}

WallGroup::WallGroup(const Model& model, const std::function<bool(int)>& wanted) : model_(model) {
  walls_.reserve(model.walls.size());
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    for (const int p : model.walls[w].particles)
      if (wanted(p)) particle_.push_back(p), wall_.push_back(static_cast<int>(w));
    const Wall& wall = model.walls[w];
    load_dependent_ = load_dependent_ || (wall.scaling.rate != 0 && (!wall.displacement.isZero(0) || wall.radius_change != 0));
  }
}

const std::vector<WallContact>& WallGroup::at(double load_factor) const {
  walls_.clear();
  for (const Wall& w : model_.walls) walls_.push_back(wall_at(w, load_factor));
  return walls_;
}

void WallGroup::values(const State& state, double* value) const {
  const std::vector<WallContact>& walls = at(state.load_factor);
  parallel_for(elements(), touches_per_thread, [&](std::int64_t e) {
    value[e] = walls[wall_[e]].value(state.at(particle_[e]), model_.diameter[particle_[e]] / 2);
  });
}

void WallGroup::derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const {
  const std::vector<WallContact>& walls = at(state.load_factor);
  parallel_for(elements(), touches_per_thread, [&](std::int64_t e) {
    store(walls[wall_[e]].derivatives(state.at(particle_[e]), model_.diameter[particle_[e]] / 2), e, value, gradient, hessian);
  });
}

void WallGroup::explicit_load_derivative(const State& state, double* rate) const {
  const std::vector<WallContact>& walls = at(state.load_factor);
  parallel_for(elements(), touches_per_thread, [&](std::int64_t e) {
    const Wall& wall = model_.walls[wall_[e]];
    const WallContact& law = walls[wall_[e]];
    const ExactVector x = state.at(particle_[e]);
    const double r = model_.diameter[particle_[e]] / 2;
    Vec3 v = -(law.derivatives(x, r).hessian * wall.displacement);
    if (wall.radius_change != 0) v += wall.radius_change * law.radius_rate(x, r);
    Eigen::Map<Vec3>(rate + 3 * e) = wall.scaling.rate * v;
  });
}

}  // namespace elamin
