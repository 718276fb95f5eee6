#pragma once
// What a run found, as curves of one column of its tables against another.
#include "figures/axes.hpp"
#include "results/table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace elamin {

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
  bool empty() const;                                     // there is at most one point
};

/// The names of the two columns asked for; "": what suits the table.
struct Axes {
  std::string x, y;
};

/// Of path.csv: a curve is stable or not, a snap leads from one to another, branches or stages have a colour each. Default axes: the load
/// factor, and the first column observed that changes.
Diagram path_diagram(const Table& path, const Axes& axes, const std::string& file);
/// Of trajectory.csv: time, and the first column observed that changes, or the kinetic energy.
Diagram motion_diagram(const Table& trajectory, const Axes& axes, const std::string& file);
/// Of modes.csv: eigenvalues by number.
Diagram modes_diagram(const Table& modes, const Axes& axes, const std::string& file);
/// Of sweep.csv: what is swept, and the load factor of the first kind of event that there is, or what is observed at the end; one colour for
/// each combination of the other swept keys.
Diagram sweep_diagram(const Table& sweep, const Axes& axes, const std::string& file);

/// Draws it with axes and legend into a rectangle of the page. Returns the lower end of all that.
double draw_diagram(Drawing& drawing, const Diagram& diagram, const Vec2& corner, double width, double height);

}  // namespace elamin
