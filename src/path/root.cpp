#include "path/root.hpp"

#include "path/limits.hpp"

#include <cassert>
#include <cmath>

namespace elamin {

using namespace limits;

std::optional<Sample> find_zero(Sample a, Sample b, const std::function<double(double)>& resolution,
                                const std::function<std::optional<Sample>(double, const Sample&)>& evaluate, double leap) {
  assert((a.f <= 0) != (b.f <= 0) || a.f == 0 || b.f == 0);
  double weight_a = a.f, weight_b = b.f;
  const double whole = std::abs(b.t - a.t), least_a = leap * std::abs(a.f), least_b = leap * std::abs(b.f);
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
    if (std::abs(b.t - a.t) < root::narrow * whole && std::abs(a.f) > least_a && std::abs(b.f) > least_b) return {};
  }
  return std::abs(a.f) < std::abs(b.f) ? a : b;
}

}  // namespace elamin
