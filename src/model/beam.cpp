#include "model/beam.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

/// √a: one Newton step r + (a − r²)/(2r) from the rounded root doubles its digits.
Exact square_root(Exact a) {
  const double r = std::sqrt(a.hi);
  if (r == 0) return {};
  const Exact rest = a - two_product(r, r);
  return quick_two_sum(r, rest.value() / (2 * r));
}

/// Length of d. Scaled by a power of 2 so that no square leaves the range of the doubles.
Exact length(ExactVector d) {
  if (!d.hi.allFinite()) return {d.hi.norm(), 0};
  const double largest = d.hi.cwiseAbs().maxCoeff();
  if (largest == 0) return {};
  const int exponent = std::ilogb(largest);
  const auto scale = [](double x, int power) { return std::ldexp(x, power); };
  for (int c = 0; c < 3; ++c) d.set(c, {scale(d.hi[c], -exponent), scale(d.lo[c], -exponent)});
  const Exact unit = square_root(dot(d, d));
  return {scale(unit.hi, exponent), scale(unit.lo, exponent)};
}

int next(const std::vector<int>& numbers) {
  return numbers.empty() ? 1 : *std::max_element(numbers.begin(), numbers.end()) + 1;
}

}  // namespace

ExactVector point_between(const ExactVector& from, const ExactVector& to, int i, int n) {
  if (i == n) return to;
  const Exact part = Exact{static_cast<double>(i), 0} / Exact{static_cast<double>(n), 0};
  ExactVector x;
  for (int c = 0; c < 3; ++c) x.set(c, from[c] + (to[c] - from[c]) * part);
  return x;
}

Exact distance(const ExactVector& a, const ExactVector& b) { return length(b - a); }

std::array<ExactVector, 2> ends_of_row(const Vec3& center, const Vec3& axis, double spacing, int n) {
  // Half the row along the unit axis: a/|a| · s n/2. A power of 2 in the axis changes nothing but its range.
  const int exponent = std::ilogb(axis.cwiseAbs().maxCoeff());
  Vec3 direction;
  for (int c = 0; c < 3; ++c) direction[c] = std::ldexp(axis[c], -exponent);
  const Exact norm = length({direction, Vec3::Zero()});
  const Exact half = two_product(spacing, n / 2.0);
  std::array<ExactVector, 2> ends;
  for (int c = 0; c < 3; ++c) {
    const Exact offset = Exact{direction[c], 0} * half / norm;
    ends[0].set(c, -offset + center[c]);
    ends[1].set(c, offset + center[c]);
  }
  return ends;
}

void add_beams(Model& model, const std::vector<StraightBeam>& beams) {
  int first = model.particles(), total = first;
  for (const StraightBeam& beam : beams) total += beam.particles;
  model.start.position.conservativeResize(3, total);
  model.start.tail.conservativeResize(3, total);
  if (model.velocity.cols() > 0) {
    model.velocity.conservativeResize(3, total);
    model.velocity.rightCols(total - first).setZero();
  }
  int id = next(model.id), type = next(model.type), molecule = next(model.molecule);
  for (const StraightBeam& beam : beams) {
    const int n = beam.particles, end = first + n;
    for (int i = 0; i < n; ++i) model.start.set(first + i, point_between(beam.from, beam.to, i, n - 1));
    for (int i = 0; i < n; ++i) model.id.push_back(id++);
    model.type.resize(end, type++);
    model.molecule.resize(end, molecule++);
    model.diameter.resize(end, beam.diameter);
    model.density.resize(end, beam.density);

    const int bond_type = static_cast<int>(model.bond_types.size()),
              angle_type = static_cast<int>(model.angle_types.size());
    model.bond_types.push_back(beam.bond);
    model.angle_types.push_back(beam.angle);
    for (int i = first; i + 1 < end; ++i) model.bonds.push_back({bond_type, {i, i + 1}});
    for (int i = first; i + 2 < end; ++i) model.angles.push_back({angle_type, {i, i + 1, i + 2}});
    model.structures.push_back({beam.name, "beam", first, n, beam.youngs_modulus, bond_type, angle_type});
    first = end;
  }
}

}  // namespace elamin
