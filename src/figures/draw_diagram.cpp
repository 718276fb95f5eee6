#include "figures/diagram.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace elamin {
namespace {

constexpr double legend_type = 6.5, thick_line = 1.3, thin_line = 0.7, invisible = 0.04;     // [pt]
const char* const dashes = "2.6 1.6";
const char* const dots = "0.7 1.5";

// Kinds of events in the order in which legends have them; whatever else happens is a square.
const std::vector<std::string> marked_kinds{"branch", "limit", "contact", "jump"};

void draw_mark(Drawing& drawing, const std::string& kind, const Vec2& at) {
  const Pen pen{"#000000", 0.6};
  const auto corners = [&](std::initializer_list<Vec2> offsets) {
    Polyline all;
    for (const Vec2& o : offsets) all.push_back(at + o);
    drawing.area(all, "#ffffff", pen);
  };
  if (kind == "branch") drawing.circle(at, 1.9, "#ffffff", pen);
  else if (kind == "limit") corners({{-2.1, 1.6}, {2.1, 1.6}, {0, -2.2}});
  else if (kind == "contact") corners({{-1.9, 0}, {0, 1.9}, {1.9, 0}, {0, -1.9}});
  else if (kind == "jump") drawing.lines({{at + Vec2(-1.5, -1.5), at + Vec2(1.5, 1.5)}, {at + Vec2(-1.5, 1.5), at + Vec2(1.5, -1.5)}}, pen);
  else corners({{-1.6, -1.6}, {1.6, -1.6}, {1.6, 1.6}, {-1.6, 1.6}});
}

// An entry of the legend: a sign and what it means.
struct LegendEntry {
  std::string meaning;
  std::function<void(Drawing&, const Vec2&)> sign;       // at the middle of its place
};

std::vector<LegendEntry> entries_of(const Diagram& d) {
  std::vector<LegendEntry> all;
  std::set<Curve::Kind> styles;
  for (const Curve& c : d.curves)
    if (c.points.size() > 1 || c.kind == Curve::Kind::points) styles.insert(c.kind);
  const auto line = [&](const char* meaning, const Pen& pen) {
    all.push_back({meaning, [pen](Drawing& to, const Vec2& at) { to.lines({{at - Vec2(6, 0), at + Vec2(6, 0)}}, pen); }});
  };
  const std::string any = d.names.empty() ? colour(0) : "#000000";
  if (styles.count(Curve::Kind::unstable)) {
    if (styles.count(Curve::Kind::stable)) line("stable", {any, thick_line});
    line("unstable", {any, thin_line, dashes});
  }
  if (styles.count(Curve::Kind::snap)) line("snap", {"#555555", thin_line, dots});
  constexpr std::size_t most = 8;
  for (std::size_t k = 0; k < d.names.size() && k < most; ++k)
    all.push_back({d.names[k], [k](Drawing& to, const Vec2& at) { to.lines({{at - Vec2(6, 0), at + Vec2(6, 0)}}, {colour(static_cast<int>(k)), thick_line}); }});
  std::set<std::string> there;
  for (const EventMark& m : d.marks) there.insert(m.kind);
  std::vector<std::string> ordered;
  for (const std::string& kind : marked_kinds)
    if (there.erase(kind)) ordered.push_back(kind);
  ordered.insert(ordered.end(), there.begin(), there.end());
  for (const std::string& kind : ordered) {
    const std::string meaning = kind == "branch" || kind == "limit" ? kind + " point" : kind;
    all.push_back({meaning, [kind](Drawing& to, const Vec2& at) { draw_mark(to, kind, at); }});
  }
  return all;
}

// In lines across the width; returns where the next line would be.
double draw_legend(Drawing& drawing, const std::vector<LegendEntry>& entries, const Vec2& corner, double width) {
  constexpr double sign = 16, space = 8, line = 9;
  double x = corner.x(), y = corner.y();
  for (const LegendEntry& e : entries) {
    const double wide = sign + width_of(e.meaning, legend_type);
    if (x > corner.x() && x + wide > corner.x() + width) x = corner.x(), y += line;
    e.sign(drawing, {x + 6, y + 4.5});
    drawing.words({x + sign - 1, y + 6.8}, e.meaning, Anchor::start, legend_type);
    x += wide + space;
  }
  return entries.empty() ? y : y + line;
}

}  // namespace

double draw_diagram(Drawing& drawing, const Diagram& d, const Vec2& corner, double width, double height) {
  Extent x, y;
  for (const Curve& c : d.curves)
    for (const Vec2& p : c.points) x.add(p.x()), y.add(p.y());
  PlotArea f{{}, {}, with_room(x), with_room(y), d.whole_x, d.decades};
  double widest = 0;
  for (const std::string& label : f.up().labels) widest = std::max(widest, 1.2 * width_of(label, legend_type));   // where a wider typeface stands in
  const double left = corner.x() + widest + 16;
  const double top = draw_legend(drawing, entries_of(d), {left, corner.y()}, corner.x() + width - left) + 3;
  f.lo = {left, top + height}, f.hi = {corner.x() + width - 2, top};
  draw_axes(drawing, f, d.x, d.y);
  for (const Curve& c : d.curves) {
    Polyline line;
    for (const Vec2& p : c.points) line.push_back(f.at(p.x(), p.y()));
    const std::string& its = colour(c.colour);
    if (c.kind != Curve::Kind::points) {
      const Pen pen = c.kind == Curve::Kind::stable ? Pen{its, thick_line} : c.kind == Curve::Kind::unstable ? Pen{its, thin_line, dashes} : Pen{"#555555", thin_line, dots};
      drawing.lines({thinned(line, invisible)}, pen);
      continue;
    }
    drawing.lines({line}, {its, 0.5});
    drawing.discs(line, line.size() > 60 ? 0.9 : 1.5, its);
  }
  // Of marks of one kind that lie on each other one is seen.
  std::map<std::string, std::vector<Vec2>> drawn;
  for (const EventMark& m : d.marks) {
    const Vec2 at = f.at(m.at.x(), m.at.y());
    std::vector<Vec2>& others = drawn[m.kind];
    if (std::any_of(others.begin(), others.end(), [&](const Vec2& o) { return (o - at).norm() < 1.2; })) continue;
    others.push_back(at);
    draw_mark(drawing, m.kind, at);
  }
  return f.lo.y() + 21;
}

}  // namespace elamin
