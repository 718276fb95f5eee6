#include "figures/diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace elamin {
namespace {

// Dots on a grid of characters of 2 × 4, and letters above them.
class Dots {
 public:
  Dots(int width, int height) : width_(width), height_(height), dots_(static_cast<std::size_t>(width * height), 0) {}

  // A line in which `on` dots of every `period` are seen, counted on from line to line.
  void line(const Vec2& from, const Vec2& to, int on, int period, int& count) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())));
    for (int k = 0; k <= steps; ++k, ++count)
      if (count % period < on) dot(from + (to - from) * (static_cast<double>(k) / steps));
  }
  void dot(const Vec2& at) {
    static constexpr unsigned char bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};       // of U+2800
    const auto [x, y] = cell(at);
    dots_[y / 4 * width_ + x / 2] |= bits[y % 4][x % 2];
  }
  void letter(const Vec2& at, char c) {
    const auto [x, y] = cell(at);
    letters_[y / 4 * width_ + x / 2] = c;
  }
  std::string row(int k) const {
    std::string text;
    for (int i = k * width_; i < (k + 1) * width_; ++i) {
      const unsigned char d = dots_[i];
      if (const auto found = letters_.find(i); found != letters_.end()) text += found->second;
      else if (d == 0) text += ' ';
      else text += {'\xE2', static_cast<char>(0xA0 + (d >> 6)), static_cast<char>(0x80 + (d & 63))};
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }

 private:
  std::pair<int, int> cell(const Vec2& at) const {
    const auto within = [](double v, int count) { return std::clamp(static_cast<int>(std::lround(v)), 0, count - 1); };
    return {within(at.x(), 2 * width_), within(at.y(), 4 * height_)};
  }
  int width_, height_;
  std::vector<unsigned char> dots_;
  std::map<int, char> letters_;
};

}  // namespace

std::string braille(const Diagram& d, int width, int height) {
  Extent x, y;
  for (const Curve& c : d.curves)
    for (const Vec2& p : c.points) x.add(p.x()), y.add(p.y());
  for (Extent* range : {&x, &y})
    if (range->empty() || !(range->hi > range->lo)) *range = with_room(*range);
  const auto number = [](double v) { return fmt::format("{:.4g}", v); };
  const auto up = [&](double v) { return number(d.decades ? std::pow(10, v) : v); };
  const int margin = static_cast<int>(std::max(up(y.lo).size(), up(y.hi).size())), columns = std::max(10, width - margin - 2);
  Dots dots(columns, height);
  const auto at = [&](const Vec2& p) {
    return Vec2((p.x() - x.lo) / (x.hi - x.lo) * (2 * columns - 1), (y.hi - p.y()) / (y.hi - y.lo) * (4 * height - 1));
  };
  for (const Curve& c : d.curves) {
    const bool unstable = c.kind == Curve::Kind::unstable, points = c.kind == Curve::Kind::points;
    const int on = unstable ? 2 : 1, period = unstable ? 4 : c.kind == Curve::Kind::snap ? 3 : 1;
    int count = 0;
    for (std::size_t i = 0; i < c.points.size(); ++i)
      if (points) dots.letter(at(c.points[i]), 'o');
      else if (i > 0) dots.line(at(c.points[i - 1]), at(c.points[i]), on, period, count);
  }
  std::map<std::string, char> letters;                     // a kind's first letter that is free
  for (const EventMark& m : d.marks) {
    const auto taken = [&](char c) { return std::any_of(letters.begin(), letters.end(), [&](const auto& l) { return l.second == c; }); };
    if (!letters.count(m.kind)) {
      const auto free = std::find_if(m.kind.begin(), m.kind.end(), [&](char c) { return !taken(c); });
      letters[m.kind] = free == m.kind.end() ? '+' : *free;
    }
    dots.letter(at(m.at), letters[m.kind]);
  }
  std::string text = fmt::format("{:>{}}\n", d.y, std::max<std::size_t>(static_cast<std::size_t>(margin), d.y.size()));
  for (int k = 0; k < height; ++k)
    text += fmt::format("{:>{}} │{}\n", k == 0 ? up(y.hi) : k + 1 == height ? up(y.lo) : "", margin, dots.row(k));
  const std::string lo = number(x.lo), hi = number(x.hi), name = d.x;
  const int between = columns - static_cast<int>(lo.size() + hi.size() + name.size());
  const auto blanks = [](int n) { return std::string(static_cast<std::size_t>(std::max(1, n)), ' '); };
  text += blanks(margin + 2) + lo + blanks(between / 2) + name + blanks(between - between / 2) + hi + "\n";
  std::string key;
  for (const auto& [kind, letter] : letters) key += fmt::format("{}{} {}", key.empty() ? "" : ", ", letter, kind);
  return key.empty() ? text : text + fmt::format("{:>{}} {}\n", "", margin + 1, key);
}

}  // namespace elamin
