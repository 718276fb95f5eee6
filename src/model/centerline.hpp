#pragma once
// Where the particles of a beam are: on a straight row, on straight pieces, on an arc, on half a sine wave: there neighbours are
// equally far from each other everywhere. Or along any curve, where they are so along the curve.
#include "core/exact.hpp"

#include <array>
#include <optional>
#include <vector>

namespace elamin {

struct Centerline {
  std::vector<ExactVector> centers;
  double spacing = 0;               // distance of neighbours [length]
};

/// Ends at which a row is clamped: there it goes on by one particle beyond the end. This and the end's own are to be
/// held.
struct Clamped {
  bool from = false, to = false;
};

/// The point from + (to − from) · i/n, to about 32 digits of the larger coordinates.
ExactVector point_between(const ExactVector& from, const ExactVector& to, int i, int n);

/// |b − a| to about 30 digits.
Exact distance(const ExactVector& a, const ExactVector& b);

/// The two ends of a row of n + 1 points with that spacing along `axis` (of any length but zero), `center` in the
/// middle.
std::array<ExactVector, 2> ends_of_row(const Vec3& center, const Vec3& axis, double spacing, int n);

/// Evenly from one point to another; at least 2 particles, and one more for each clamp.
Centerline row(const ExactVector& from, const ExactVector& to, int particles, Clamped clamped = {});

/// Evenly along straight pieces from corner to corner, at least two corners, a particle on every one between the ends.
/// None if that number of particles puts none there (to 1e-12 of the whole length), or less than one bond between two.
[[nodiscard]] std::optional<Centerline> polyline(const std::vector<Vec3>& corners, int particles, Clamped clamped = {});

/// Evenly by length along the straight pieces through two points or more, no two that follow in one place; `spacing` is that length.
/// Neighbours between which the line bends are nearer to each other.
Centerline along_curve(const std::vector<Vec3>& points, int particles, Clamped clamped = {});

/// The nearest numbers of particles below and above that `polyline` takes; 0: none as far as 10⁴ particles away.
std::array<int, 2> fitting(const std::vector<Vec3>& corners, int particles, Clamped clamped = {});

/// An arch stands on its ends and rises to one side of the line between them, along the part of `toward` across it.
struct Arch {
  Vec3 from, to, toward;
};

/// Whether `toward` leads to a side of the line, by more than rounding.
bool rises(const Arch& arch);

/// On a circle through both ends, `turns` of the whole, 0 < turns < 1: a piece of a regular polygon.
/// R = c/(2 sin(α/2)), c = |to − from|, α = 2π·turns.
Centerline arc(const Arch& arch, Exact turns, int particles, Clamped clamped = {});

/// The turns of the arc with chord c that rises by h > 0 in its middle: tan(α/4) = 2h/c.
Exact turns_of_rise(double chord, double rise);

/// On half a sine wave from end to end, y = h sin(πx/c), h the rise (negative: to the other side), with equal distances
/// between neighbours. None if no such points are found.
[[nodiscard]] std::optional<Centerline> half_sine(const Arch& arch, double rise, int particles);

}  // namespace elamin
