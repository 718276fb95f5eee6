#pragma once
// Points of the triangular lattice within an outline, row after row, and who is whose neighbour.
#include <array>
#include <cstdint>
#include <vector>

namespace elamin {

/// The lattice point i a₁ + j a₂, with |a₁| = |a₂| = 1 and a₂ 60° from a₁; j is the row, i the place along it.
struct LatticePoint { std::int64_t i = 0, j = 0; };

/// The three directions in which neighbours lie, a₁, a₂ and a₂ − a₁: 0°, 60° and 120° against the rows.
constexpr std::array<LatticePoint, 3> lattice_directions{{{1, 0}, {0, 1}, {-1, 1}}};

/// What is within:
///   rectangle  0 ≤ u ≤ width, 0 ≤ v ≤ height, the rows at `angle` against u, a lattice point in the corner u = v = 0
///   circle     |x| ≤ width around a lattice point
///   rolled     0 ≤ x·C < |C|² and 0 ≤ C × x ≤ height, in cells of the lattice: what a roll along C = n₁ a₁ + n₂ a₂ leaves
///              of points that are multiples of C apart
/// Lengths in units of the spacing, edges included within 1e-9 of it.
struct Outline {
  enum class Kind { rectangle, circle, rolled } kind = Kind::rectangle;
  double width = 0, height = 0;
  double cosine = 1, sine = 0;                     // rectangle: of the angle
  std::int64_t n1 = 0, n2 = 0;                     // rolled

  /// n₁² + n₁n₂ + n₂² = |C|².
  std::int64_t square() const { return n1 * n1 + n1 * n2 + n2 * n2; }
  /// How far around: 2 x·C, a whole number, 2|C|² once around.
  std::int64_t around(const LatticePoint& p) const { return p.i * (2 * n1 + n2) + p.j * (n1 + 2 * n2); }
  /// How far up: C × x in cells, a whole number; one of them is √3/2/|C|.
  std::int64_t up(const LatticePoint& p) const { return n1 * p.j - n2 * p.i; }
};

/// How many lattice points are within, or the largest int where there are more than that (or than 2e7 rows).
int count_points(const Outline& outline);

/// The points within, numbered from 0: rows ascending, along each row ascending. Fewer than the largest int.
class LatticePatch {
 public:
  explicit LatticePatch(const Outline& outline);

  int size() const { return size_; }
  /// Number of a point, −1 if it is not within; where the outline is rolled any of the points that are one.
  int find(LatticePoint p) const;
  /// body(number, point) for all of them.
  template <class Body>
  void for_each(const Body& body) const {
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (std::int64_t i = rows_[r].from; i <= rows_[r].to; ++i)
        body(number(rows_[r], i), LatticePoint{i, lowest_ + static_cast<std::int64_t>(r)});
  }

 private:
  struct Row {
    std::int64_t from, to;
    int first;
  };
  static int number(const Row& row, std::int64_t i) { return row.first + static_cast<int>(i - row.from); }

  Outline outline_;
  std::int64_t lowest_ = 0;
  int size_ = 0;
  std::vector<Row> rows_;
};

}  // namespace elamin
