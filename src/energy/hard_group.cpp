#include "energy/hard_group.hpp"

#include "energy/hard_gaps.hpp"

#include <algorithm>

namespace elamin {

namespace {

// Adds factor · (entries of the lower triangle) to an element's packed Hessian, which has the coordinates from `first` on.
void add_packed(const HardGap& gap, double factor, int first, double* hessian) {
  for (int r = first; r < 3 * gap.sites; ++r)
    for (int c = first; c <= r; ++c) *hessian++ += factor * gap.hessian(r, c);
}

void clear(const ElementGroup& group, double* value, double* gradient, double* hessian) {
  std::fill_n(value, group.elements(), 0.0);
  std::fill_n(gradient, std::int64_t(group.elements()) * group.gradient_size(), 0.0);
  if (hessian) std::fill_n(hessian, std::int64_t(group.elements()) * group.hessian_size(), 0.0);
}

// −f c of one contact into the buffers of its element.
void add(const ElementGroup& group, const HardGap& gap, double force, std::int64_t e, double* gradient, double* hessian) {
  Eigen::Map<Vector>(gradient + e * group.gradient_size(), group.gradient_size()) -= force * gap.gradient.head(group.gradient_size());
  if (hessian) add_packed(gap, -force, group.hessian_first(), hessian + e * group.hessian_size());
}

}  // namespace

HardPairGroup::HardPairGroup(const Model& model, const std::vector<IndexPair>& pairs) : model_(model) {
  for (const auto& [i, j] : pairs) stencils_.push_back({i, j});
}

void HardPairGroup::values(const State&, double* value) const { std::fill_n(value, elements(), 0.0); }

void HardPairGroup::derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const {
  clear(*this, value, gradient, hessian);
  HardGap gap;
  for (const HardForce& h : state.hard) {
    if (h.wall >= 0 || h.force == 0) continue;
    const auto at = std::lower_bound(stencils_.begin(), stencils_.end(), std::array{h.particle, h.other});
    if (at == stencils_.end() || *at != std::array{h.particle, h.other}) continue;
    if (hard_gap(model_, h, state, gap)) add(*this, gap, h.force, at - stencils_.begin(), gradient, hessian);
  }
}

HardWallGroup::HardWallGroup(const Model& model) : model_(model) {
  for (const Wall& wall : model.walls) {
    first_.push_back(elements());
    if (!wall.hard) continue;
    particle_.insert(particle_.end(), wall.particles.begin(), wall.particles.end());
    load_dependent_ = load_dependent_ || (wall.scaling.rate != 0 && (!wall.displacement.isZero(0) || wall.radius_change != 0));
  }
}

int HardWallGroup::element_of(int wall, int particle) const {
  if (!model_.walls[wall].hard) return -1;
  const std::vector<int>& particles = model_.walls[wall].particles;
  const auto at = std::lower_bound(particles.begin(), particles.end(), particle);
  return at != particles.end() && *at == particle ? first_[wall] + static_cast<int>(at - particles.begin()) : -1;
}

void HardWallGroup::values(const State&, double* value) const { std::fill_n(value, elements(), 0.0); }

void HardWallGroup::derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const {
  clear(*this, value, gradient, hessian);
  HardGap gap;
  for (const HardForce& h : state.hard)
    if (const int e = h.wall >= 0 && h.force != 0 ? element_of(h.wall, h.particle) : -1; e >= 0 && hard_gap(model_, h, state, gap))
      add(*this, gap, h.force, e, gradient, hessian);
}

void HardWallGroup::explicit_load_derivative(const State& state, double* rate) const {
  std::fill_n(rate, 3 * std::int64_t(elements()), 0.0);
  HardGap gap;
  for (const HardForce& h : state.hard)
    if (const int e = h.wall >= 0 ? element_of(h.wall, h.particle) : -1; e >= 0 && hard_gap(model_, h, state, gap))
      Eigen::Map<Vec3>(rate + 3 * std::int64_t(e)) -= h.force * gap.gradient_rate;
}

}  // namespace elamin
