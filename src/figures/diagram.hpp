#pragma once
// What a run found, as curves of one column of its tables against another.
#include "figures/drawing.hpp"
#include "results/table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace elamin {

// Two axes with their ticks.

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
/// Of an axis of logarithms: at powers of ten.
Ticks decades_of(const Extent& range);

/// A frame on the page, and where numbers are in it.
struct PlotArea {
  Vec2 lo, hi;                         // corners on the page: left and low, right and high
  Extent x, y;
  bool whole_x = false;                // ticks at whole numbers only
  bool decades = false;                // y is a logarithm to the base of ten
  Ticks up() const { return decades ? decades_of(y) : ticks_of(y); }
  Vec2 at(double u, double v) const {
    return {lo.x() + (u - x.lo) / (x.hi - x.lo) * (hi.x() - lo.x()), lo.y() + (v - y.lo) / (y.hi - y.lo) * (hi.y() - lo.y())};
  }
};

/// Draws the frame with its ticks and names.
void draw_axes(Drawing& drawing, const PlotArea& frame, const std::string& x, const std::string& y);

struct Curve {
  enum class Kind { stable, unstable, snap, points };     // points: each by itself, of a sweep
  Polyline points;                                        // in the numbers of the columns
  Kind kind = Kind::stable;
  int colour = 0;
};

struct EventMark {
  std::string kind;                                       // "limit", "branch", "contact", "jump", or what an [[event]] is called
  Vec2 at;
};

struct Diagram {
  std::string x, y;                                       // names of the axes
  std::vector<Curve> curves;
  std::vector<EventMark> marks;
  std::vector<std::string> names = {};                    // of the colours; empty: there is one
  bool whole_x = false;                                   // x counts something
  bool decades = false;                                   // y is a logarithm to the base of ten
  bool empty() const;                                     // there is at most one point
};

/// The names of the two columns asked for; "": what suits the table.
struct Axes {
  std::string x, y;
};

/// Of path.csv: a curve is stable or not, a snap leads from one to another, branches or stages have a colour each. Default axes: the load
/// factor, and the first column observed that changes.
Diagram path_diagram(const Table& path, const Axes& axes, const std::string& file);
/// Of curve.csv: the load factor of a threshold against the second parameter, and what happens on the way.
Diagram curve_diagram(const Table& curve, const Axes& axes, const std::string& file);
/// Of landscape.csv, where columns are asked for: one against the other, a colour for each node that is followed over load factors.
Diagram landscape_diagram(const Table& landscape, const Axes& axes, const std::string& file);
/// Of landscape.json: the tree of its last landscape.
Diagram tree_diagram(const std::string& file);
/// Of trajectory.csv: time, and the first column observed that changes, or the kinetic energy.
Diagram motion_diagram(const Table& trajectory, const Axes& axes, const std::string& file);
/// Of modes.csv: eigenvalues by number.
Diagram modes_diagram(const Table& modes, const Axes& axes, const std::string& file);
/// Of sweep.csv: what is swept, and the load factor of the first kind of event that there is, or what is observed at the end; one colour for
/// each combination of the other swept keys.
Diagram sweep_diagram(const Table& sweep, const Axes& axes, const std::string& file);

/// Of refine.csv: how far the values of the first few quantities are from those without particles, relative to these, level by level; their names tell the
/// observed orders. None of quantities without an order.
Diagram refinement_diagram(const Table& refine, const std::string& file);

/// Draws it with axes and legend into a rectangle of the page. Returns the lower end of all that.
double draw_diagram(Drawing& drawing, const Diagram& diagram, const Vec2& corner, double width, double height);

// A diagram in characters, for a terminal.

/// Lines of `width` characters at most and height + 3 of them: the curves in dots of braille, 2 × 4 a character (unstable ones
/// with gaps, snaps dotted), events as letters, the ends of both axes, and below what the letters mean.
std::string braille(const Diagram& diagram, int width, int height);

}  // namespace elamin
