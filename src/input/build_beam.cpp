#include "input/build_beam.hpp"

#include "model/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

double largest(const Vec3& x) { return x.cwiseAbs().maxCoeff(); }

/// The corners of a beam, or its two ends.
std::vector<ExactVector> corners_of(const BeamTable& table) {
  std::vector<ExactVector> corners;
  if (table.through)
    for (const Vec3& x : *table.through) corners.push_back(exact(x));
  else if (table.from)
    corners = {exact(*table.from), exact(*table.to)};
  else
    for (const ExactVector& x : ends_of_row(*table.center, *table.axis, table.spacing.value_or(table.diameter),
                                            table.particles - 1))
      corners.push_back(x);
  return corners;
}

std::optional<Centerline> arch_of(const BeamTable& table, const std::string& plane, double size, Mistakes& mistakes) {
  Arch a{*table.from, *table.to, table.toward.value_or(Vec3::Zero())};
  if (!table.toward) {                               // a quarter turn of from → to in the plane
    const int u = plane[0] - 'x', v = plane[1] - 'x';
    a.toward[u] = -(a.to - a.from)[v], a.toward[v] = (a.to - a.from)[u];
  }
  const double chord = (a.to - a.from).norm();
  if (!rises(a) || chord <= 1e-12 * size) {
    mistakes.add(table.place, "to",
                 "is no place to which an arch leads from here; from and to must lie apart in the plane");
    return std::nullopt;
  }
  if (table.profile == Profile::sine) {
    std::optional<Centerline> line = half_sine(a, *table.rise, table.particles);
    if (!line)
      mistakes.add(table.place, "rise",
                   "is too high for so few particles on a sine; take more of them, or a circle");
    return line;
  }
  if (table.angle) return arc(a, exact(*table.angle) / exact(360), table.particles, clamped_ends(table));
  if (*table.rise < 0) a.toward = -a.toward;
  return arc(a, turns_of_rise(chord, std::abs(*table.rise)), table.particles, clamped_ends(table));
}

void not_on_corners(const BeamTable& table, Mistakes& mistakes) {
  const auto [below, above] = fitting(*table.through, table.particles, clamped_ends(table));
  std::string nearest;
  for (const int n : {below, above})
    if (n > 0) nearest += fmt::format("{}{}", nearest.empty() ? "" : " and ", n);
  mistakes.add(table.place, "particles",
               fmt::format("{} evenly along through put none on a corner; {}", table.particles,
                           nearest.empty()
                               ? "no number near it does: the lengths between corners must have a common measure"
                               : "the nearest that do: " + nearest));
}

}  // namespace

bool lost(const TablePlace& place, const char* what, double length, double farthest, Mistakes& mistakes) {
  if (!std::isfinite(farthest))
    mistakes.add(place, "its size is beyond what numbers can hold");
  else if (length <= 1e-12 * farthest)
    mistakes.add(place, fmt::format("its {}, {}, is lost beside its coordinates, {}; place it nearer to the origin",
                                    what, length, farthest));
  else
    return false;
  return true;
}

Clamped clamped_ends(const BeamTable& table) {
  const bool both = table.clamped == ClampedEnds::both;
  return {both || table.clamped == ClampedEnds::from, both || table.clamped == ClampedEnds::to};
}

std::optional<Centerline> centerline_of(const BeamTable& table, const std::string& plane, Mistakes& mistakes) {
  const std::vector<ExactVector> corners = corners_of(table);
  double length = 0, farthest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    farthest = std::max(farthest, largest(corners[i].hi));
    if (i > 0) length += distance(corners[i - 1], corners[i]).value();
  }
  if (table.rise) length += std::abs(*table.rise), farthest += std::abs(*table.rise);
  if (!std::isfinite(length)) {
    mistakes.add(table.place, "its length is beyond what numbers can hold");
    return std::nullopt;
  }
  if (lost(table.place, "spacing", length / (table.particles - 1), farthest, mistakes)) return std::nullopt;
  if (table.rise || table.angle) return arch_of(table, plane, length, mistakes);
  if (!table.through) return row(corners.front(), corners.back(), table.particles, clamped_ends(table));
  std::optional<Centerline> line = polyline(*table.through, table.particles, clamped_ends(table));
  if (!line) not_on_corners(table, mistakes);
  return line;
}

}  // namespace elamin
