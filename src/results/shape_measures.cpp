#include "results/shape_measures.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

Vec3 value(const ExactVector& v) { return v.hi + v.lo; }

/// The mean way to some places from one.
Vec3 mean_way(const State& state, const ExactVector& from, const std::vector<int>& to) {
  ExactSum sums[3];
  for (const int e : to) {
    const Vec3 d = value(place_of(state, e) - from);
    for (int c = 0; c < 3; ++c) sums[c].add(d[c]);
  }
  return Vec3(sums[0].value(), sums[1].value(), sums[2].value()) / static_cast<double>(to.size());
}

}  // namespace

ExactVector place_of(const State& state, int entity) {
  const auto n = static_cast<int>(state.particles());
  return entity < n ? state.at(entity) : state.bodies[entity - n].position;
}

double length_of(const Vec3& v) { return std::hypot(v[0], v[1], v[2]); }

Vec3 way(const State& state, const std::vector<int>& from, const std::vector<int>& to) {
  const ExactVector origin = place_of(state, from.front());
  return mean_way(state, origin, to) - mean_way(state, origin, from);
}

double angle(const Vec3& u, const Vec3& v, const std::optional<Vec3>& about) {
  if (!about) return std::atan2(u.cross(v).norm(), u.dot(v));
  const Vec3 n = about->normalized(), across = u - u.dot(n) * n;
  return std::atan2(n.dot(across.cross(v)), across.dot(v));
}

double opening(const Vec3& u, const Vec3& v, const std::optional<Vec3>& about) {
  const double a = angle(u, v, about);
  return a < 0 ? a + 2 * pi : a;
}

double extent(const State& state, const std::vector<int>& entities, int c) {
  const auto less = [&](int a, int b) { return (place_of(state, a) - place_of(state, b))[c].value() < 0; };
  const auto [least, most] = std::minmax_element(entities.begin(), entities.end(), less);
  return (place_of(state, *most) - place_of(state, *least))[c].value();
}

Vec3 end_bond(const State& state, const std::vector<int>& row, bool last) {
  const std::size_t first = last ? row.size() - 2 : 0;
  return value(state.at(row[first + 1]) - state.at(row[first]));
}

Vec3 vector_area(const State& state, const std::vector<int>& row) {
  const ExactVector origin = state.at(row.front());
  ExactSum sums[3];
  Vec3 before = Vec3::Zero();
  for (const int i : row) {
    const Vec3 here = value(state.at(i) - origin), twice = before.cross(here);
    for (int c = 0; c < 3; ++c) sums[c].add(twice[c]);
    before = here;
  }
  return Vec3(sums[0].value(), sums[1].value(), sums[2].value()) / 2;
}

}  // namespace elamin
