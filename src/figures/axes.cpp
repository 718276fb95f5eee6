#include "figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace elamin {
namespace {

constexpr double small_type = 6.5, type = 7.5;

// "name (10⁻³)", or the name alone.
std::string with_factor(const std::string& name, int exponent) {
  if (exponent == 0) return name;
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string power = exponent < 0 ? "⁻" : "";
  for (const char digit : fmt::format("{}", std::abs(exponent))) power += raised[static_cast<std::size_t>(digit - '0')];
  return fmt::format("{} (10{})", name, power);
}

}  // namespace

void Extent::add(double v) {
  if (empty()) lo = hi = v;
  lo = std::min(lo, v), hi = std::max(hi, v);
}

Extent with_room(const Extent& range) {
  if (range.empty()) return {0, 1};
  const double size = std::max(std::abs(range.lo), std::abs(range.hi));
  double room = 0.04 * (range.hi - range.lo);
  if (!(range.hi - range.lo > 1e-9 * size)) room = size > 0 ? 0.1 * size : 1;
  return {range.lo - room, range.hi + room};
}

Ticks ticks_of(const Extent& range, bool whole) {
  constexpr int about = 5;
  const double rough = (range.hi - range.lo) / about, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= 0.8 * rough) {
      step = m * power;
      break;
    }
  if (whole) step = std::max(1.0, std::round(step));
  Ticks ticks;
  const double size = std::max(std::abs(range.lo), std::abs(range.hi));
  const int order = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  if (order < -2 || order > 3) ticks.exponent = order;
  const double unit = std::pow(10.0, ticks.exponent);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step / unit) - 1e-9)));
  for (double k = std::ceil(range.lo / step - 1e-9); k * step <= range.hi + 1e-9 * step; ++k) {
    ticks.values.push_back(k * step);
    std::string label = fmt::format("{:.{}f}", std::abs(k * step / unit), decimals);
    ticks.labels.push_back(k < 0 ? "−" + label : label);
  }
  return ticks;
}

void draw_axes(Drawing& drawing, const PlotArea& f, const std::string& x, const std::string& y) {
  constexpr double tick = 2.5;
  const Ticks across = ticks_of(f.x, f.whole_x), up = ticks_of(f.y);
  std::vector<Polyline> marks;
  double widest = 0;
  for (std::size_t i = 0; i < across.values.size(); ++i) {
    const Vec2 at = f.at(across.values[i], f.y.lo);
    marks.push_back({at, at - Vec2(0, tick)});
    drawing.words(at + Vec2(0, 8.5), across.labels[i], Anchor::middle, small_type);
  }
  for (std::size_t i = 0; i < up.values.size(); ++i) {
    const Vec2 at = f.at(f.x.lo, up.values[i]);
    marks.push_back({at, at + Vec2(tick, 0)});
    drawing.words(at + Vec2(-2.5, 2.3), up.labels[i], Anchor::end, small_type);
    widest = std::max(widest, 1.2 * width_of(up.labels[i], small_type));
  }
  drawing.lines(marks, {});
  drawing.area({f.lo, {f.hi.x(), f.lo.y()}, f.hi, {f.lo.x(), f.hi.y()}}, "", {});
  drawing.words({(f.lo.x() + f.hi.x()) / 2, f.lo.y() + 18.5}, with_factor(x, across.exponent), Anchor::middle, type);
  drawing.words({f.lo.x() - 6.5 - widest, (f.lo.y() + f.hi.y()) / 2}, with_factor(y, up.exponent), Anchor::middle, type, true);
}

}  // namespace elamin
