#pragma once
// Two axes with their ticks.
#include "figures/drawing.hpp"

namespace elamin {

/// A range of numbers; what is added to it widens it.
struct Extent {
  double lo = 1, hi = 0;               // lo > hi: empty
  bool empty() const { return lo > hi; }
  void add(double v);
};

/// A range for an axis: with a little room on both sides; numbers that differ by rounding alone are one.
Extent with_room(const Extent& range);

/// Numbers on an axis: 1, 2 or 5 times a power of ten apart, five or so, as multiples of 10^exponent.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
  int exponent = 0;
};
Ticks ticks_of(const Extent& range, bool whole = false);

/// A frame on the page, and where numbers are in it.
struct PlotArea {
  Vec2 lo, hi;                         // corners on the page: left and low, right and high
  Extent x, y;
  bool whole_x = false;                // ticks at whole numbers only
  Vec2 at(double u, double v) const {
    return {lo.x() + (u - x.lo) / (x.hi - x.lo) * (hi.x() - lo.x()), lo.y() + (v - y.lo) / (y.hi - y.lo) * (hi.y() - lo.y())};
  }
};

/// Draws the frame with its ticks and names.
void draw_axes(Drawing& drawing, const PlotArea& frame, const std::string& x, const std::string& y);

}  // namespace elamin
