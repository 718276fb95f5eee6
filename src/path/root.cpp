#include "path/root.hpp"

#include "path/limits.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace elamin {

using namespace limits;

std::optional<Sample> find_zero(Sample a, Sample b, const std::function<double(double)>& resolution,
                                const std::function<std::optional<Sample>(double, const Sample&)>& evaluate, double next_to_none) {
  assert((a.f <= 0) != (b.f <= 0) || a.f == 0 || b.f == 0);
  double weight_a = a.f, weight_b = b.f, whole = std::abs(b.t - a.t), rise = std::abs(b.f - a.f);
  for (int k = 0; k < root::most_evaluations; ++k) {
    const double width = b.t - a.t;
    double t = a.t - weight_a * width / (weight_b - weight_a);
    if (k % 4 == 3) t = (a.t + b.t) / 2;
    const Sample& nearest = std::abs(t - a.t) < std::abs(t - b.t) ? a : b;
    if (std::abs(width) <= 2 * resolution(t) || std::abs(t - nearest.t) <= resolution(t) / 4) break;
    std::optional<Sample> c = evaluate(t, nearest);
    if (!c) return {};
    if ((c->f < 0) == (a.f < 0)) {
      weight_b = (k % 4 == 3) ? b.f : weight_b / 2;
      a = std::move(*c), weight_a = a.f;
    } else {
      weight_a = (k % 4 == 3) ? a.f : weight_a / 2;
      b = std::move(*c), weight_b = b.f;
    }
    if (a.f == 0 || b.f == 0) break;
    if (std::abs(b.t - a.t) > root::narrow * whole) continue;
    const double before = std::exchange(rise, std::abs(b.f - a.f));
    if (rise > std::max(root::leap * before, next_to_none)) return {};
    whole = std::abs(b.t - a.t);
  }
  return std::abs(a.f) < std::abs(b.f) ? a : b;
}

}  // namespace elamin
