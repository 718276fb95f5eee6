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
  double weight_a = a.f, weight_b = b.f, whole = std::abs(b.t - a.t), rise = std::abs(b.f - a.f), earlier = whole;
  int lately = 0;                                               // which end was replaced last: −1 a, 1 b
  bool new_a = false, new_b = false;                            // since a leap was looked for last
  for (int k = 0; k < root_search::most_evaluations; ++k) {
    const double width = b.t - a.t;
    bool halve = false;
    if (k % 4 == 3) halve = std::abs(width) > earlier / 2, earlier = std::abs(width);
    double t = a.t - weight_a * width / (weight_b - weight_a);
    if (halve) t = (a.t + b.t) / 2;
    const Sample& nearest = std::abs(t - a.t) < std::abs(t - b.t) ? a : b;
    if (std::abs(width) <= 2 * resolution(t) || std::abs(t - nearest.t) <= resolution(t) / 4) break;
    std::optional<Sample> c = evaluate(t, nearest);
    if (!c) return {};
    const int end = (c->f < 0) == (a.f < 0) ? -1 : 1;
    const auto stays = [&](double& weight, double f) { weight = halve ? f : end == lately ? weight / 2 : weight; };
    if (end < 0) a = std::move(*c), weight_a = a.f, new_a = true, stays(weight_b, b.f);
    else b = std::move(*c), weight_b = b.f, new_b = true, stays(weight_a, a.f);
    lately = end;
    if (a.f == 0 || b.f == 0) break;
    if (!new_a || !new_b || std::abs(b.t - a.t) > root_search::narrow * whole) continue;
    const double before = std::exchange(rise, std::abs(b.f - a.f));
    if (rise > std::max(root_search::leap * before, next_to_none)) return {};
    whole = std::abs(b.t - a.t), new_a = new_b = false;
  }
  return std::abs(a.f) < std::abs(b.f) ? a : b;
}

}  // namespace elamin
