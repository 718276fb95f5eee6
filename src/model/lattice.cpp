#include "model/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {
namespace {

constexpr double within_edges = 1e-9;              // of the spacing: what is that far beyond an edge is on it
constexpr double half_root_three = 0.86602540378443864676;

struct Interval {
  double from = -infinity, to = infinity;
  Interval operator&(const Interval& other) const { return {std::max(from, other.from), std::min(to, other.to)}; }
};

/// The x with lo ≤ slope·x + offset ≤ hi.
Interval where(double slope, double offset, double lo, double hi) {
  if (slope == 0) return lo <= offset && offset <= hi ? Interval{} : Interval{1, 0};
  const double a = (lo - offset) / slope, b = (hi - offset) / slope;
  return {std::min(a, b), std::max(a, b)};
}

/// The rows that may have points.
Interval rows_of(const Outline& o) {
  double width = o.width, height = o.height, cosine = o.cosine, sine = o.sine;
  if (o.kind == Outline::Kind::circle) return {-width / half_root_three - 1, width / half_root_three + 1};
  if (o.kind == Outline::Kind::rolled) {           // a rectangle along C
    width = std::sqrt(static_cast<double>(o.square()));
    height *= half_root_three / width;
    cosine = (static_cast<double>(o.n1) + static_cast<double>(o.n2) / 2) / width;
    sine = -half_root_three * static_cast<double>(o.n2) / width;
  }
  const double u = -width * sine, v = height * cosine;         // heights of its sides above the row through the corner
  return {(std::min(0.0, u) + std::min(0.0, v)) / half_root_three - 1, (std::max(0.0, u) + std::max(0.0, v)) / half_root_three + 1};
}

/// The i of the points of row j.
Interval row_of(const Outline& o, double j) {
  switch (o.kind) {
    case Outline::Kind::rectangle: {
      const double next_u = o.cosine / 2 - half_root_three * o.sine, next_v = o.sine / 2 + half_root_three * o.cosine;
      return where(o.cosine, j * next_u, -within_edges, o.width + within_edges) &
             where(o.sine, j * next_v, -within_edges, o.height + within_edges);
    }
    case Outline::Kind::circle: {
      const double radius = o.width + within_edges, above = std::abs(j) * half_root_three;
      if (above > radius) return {1, 0};
      const double half = std::sqrt((radius - above) * (radius + above));
      return where(1, j / 2, -half, half);
    }
    default: {                                     // whole numbers that doubles hold: exact
      const double n1 = static_cast<double>(o.n1), n2 = static_cast<double>(o.n2);
      const double once = 2 * static_cast<double>(o.square());
      return where(2 * n1 + n2, j * (n1 + 2 * n2), 0, once - 1) & where(-n2, j * n1, 0, o.height);
    }
  }
}

/// body(j, from, to) for every row with points, ascending, until it returns false; false if there are too many rows.
template <class Body>
bool for_each_row(const Outline& o, const Body& body) {
  const Interval rows = rows_of(o);
  if (!(rows.to - rows.from < 2e7)) return false;
  for (double j = std::ceil(rows.from); j <= rows.to; ++j) {
    const Interval row = row_of(o, j);
    const double from = std::ceil(row.from), to = std::floor(row.to);
    if (from <= to && !body(j, from, to)) return false;
  }
  return true;
}

}  // namespace

int count_points(const Outline& outline) {
  constexpr int most = std::numeric_limits<int>::max();
  if (!std::isfinite(outline.width) || !std::isfinite(outline.height)) return most;
  double count = 0;
  const auto add = [&](double, double from, double to) { return (count += to - from + 1) < most; };
  return for_each_row(outline, add) ? static_cast<int>(count) : most;
}

LatticePatch::LatticePatch(const Outline& outline) : outline_(outline) {
  for_each_row(outline, [&](double j, double from, double to) {
    if (rows_.empty()) lowest_ = static_cast<std::int64_t>(j);
    rows_.resize(static_cast<std::size_t>(j - static_cast<double>(lowest_)), {0, -1, size_});   // rows without points
    rows_.push_back({static_cast<std::int64_t>(from), static_cast<std::int64_t>(to), size_});
    size_ += static_cast<int>(to - from) + 1;
    return true;
  });
}

int LatticePatch::find(LatticePoint p) const {
  if (outline_.kind == Outline::Kind::rolled) {
    const std::int64_t once = 2 * outline_.square();
    std::int64_t around = outline_.around(p);
    for (; around < 0; around += once) p.i += outline_.n1, p.j += outline_.n2;
    for (; around >= once; around -= once) p.i -= outline_.n1, p.j -= outline_.n2;
  }
  if (p.j < lowest_ || p.j >= lowest_ + static_cast<std::int64_t>(rows_.size())) return -1;
  const Row& row = rows_[p.j - lowest_];
  return p.i < row.from || p.i > row.to ? -1 : number(row, p.i);
}

}  // namespace elamin
