#include "model/beam.hpp"

#include "model/append.hpp"
#include "model/geometry.hpp"

namespace elamin {

ExactVector point_between(const ExactVector& from, const ExactVector& to, int i, int n) {
  if (i == n) return to;
  const Exact part = exact(i) / exact(n);
  ExactVector x;
  for (int c = 0; c < 3; ++c) x.set(c, from[c] + (to[c] - from[c]) * part);
  return x;
}

Exact distance(const ExactVector& a, const ExactVector& b) { return norm(b - a); }

std::array<ExactVector, 2> ends_of_row(const Vec3& center, const Vec3& axis, double spacing, int n) {
  // Half the row along the unit axis: a/|a| · s n/2.
  const Vec3 direction = scaled(axis);
  const Exact size = norm(exact(direction)), half = two_product(spacing, n / 2.0);
  std::array<ExactVector, 2> ends;
  for (int c = 0; c < 3; ++c) {
    const Exact offset = exact(direction[c]) * half / size;
    ends[0].set(c, -offset + center[c]);
    ends[1].set(c, offset + center[c]);
  }
  return ends;
}

void add_beams(Model& model, const std::vector<StraightBeam>& beams) {
  int more = 0;
  for (const StraightBeam& beam : beams) more += beam.particles;
  Appender append(model, more);
  for (const StraightBeam& beam : beams) {
    const int n = beam.particles, first = append.together(n, beam.diameter, beam.density), end = first + n;
    for (int i = 0; i < n; ++i) model.start.set(first + i, point_between(beam.from, beam.to, i, n - 1));
    const int bond_type = add_type(model, beam.bond), angle_type = add_type(model, beam.angle);
    for (int i = first; i + 1 < end; ++i) model.bonds.push_back({bond_type, {i, i + 1}});
    for (int i = first; i + 2 < end; ++i) model.angles.push_back({angle_type, {i, i + 1, i + 2}});
    model.structures.push_back({beam.name, "beam", first, n, beam.youngs_modulus, bond_type, angle_type});
  }
}

}  // namespace elamin
