#include "energy/passage.hpp"

#include "core/near_pairs.hpp"
#include "energy/wall_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace elamin {

namespace {

constexpr double keep = 0.8;                   // of the distance, at least
constexpr double chunk = 10;                   // movement looked at in one go, in smallest distances of touch

// Distance at which a pair touches; 0: it feels nothing.
double touching(const Model& model, const ContactRules& rules, int i, int j) {
  if (const int t = rules.hertz(i, j); t >= 0 && (model.contacts[t].effective_modulus > 0 || model.contacts[t].hard))
    return (model.diameter[i] + model.diameter[j]) / 2;
  const int t = rules.lj(i, j);
  return t >= 0 && model.contacts[t].epsilon > 0 ? model.contacts[t].sigma : 0;
}

// The smaller root s > 0 of |d + s u| = floor < |d|; infinity: it stays away.
double root(const Vec3& d, const Vec3& u, double floor) {
  const double a = u.squaredNorm(), b = d.dot(u), c = d.squaredNorm() - floor * floor, discriminant = b * b - a * c;
  if (!(b < 0) || discriminant < 0) return std::numeric_limits<double>::infinity();
  return c / (-b + std::sqrt(discriminant));
}

double among_particles(const Model& model, const ContactRules& rules, const State& from, const Field& u) {
  double fastest = 0, smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < model.particles(); ++i)
    if (rules.reach(i) > 0) fastest = std::max(fastest, u.col(i).norm()), smallest = std::min(smallest, 2 * rules.reach(i));
  if (fastest == 0) return 1;
  const double width = std::min(1.0, chunk * smallest / fastest);
  std::vector<double> radii(model.particles(), 0.0);
  for (double begin = 0; begin < 1; begin += width) {
    for (int i = 0; i < model.particles(); ++i)
      if (rules.reach(i) > 0) radii[i] = rules.reach(i) + width / 2 * u.col(i).norm();
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [i, j] : near_pairs(from.position + (begin + width / 2) * u, radii,
                                         [&](int p, int q) { return touching(model, rules, p, q) > 0; })) {
      const Vec3 d = (from.at(j) - from.at(i)).hi;
      least = std::min(least, root(d, u.col(j) - u.col(i), keep * std::min(d.norm(), touching(model, rules, i, j))));
    }
    if (least <= begin + width) return std::min(1.0, least);
  }
  return 1;
}

// Distance of the particle's centre to the wall's surface; infinity where the wall does not see it.
double distance(const Wall& wall, double load_factor, const ExactVector& x, double r) {
  std::array<WallTouch, WallContact::most_faces> faces;
  const int n = wall_at(wall, load_factor).touches(x, r, std::numeric_limits<double>::infinity(), faces);
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < n; ++k) nearest = std::min(nearest, faces[k].gap + r);
  return nearest;
}

double at_wall(const Model& model, const Wall& wall, const State& from, const State& to, const Field& u) {
  constexpr int most = 200;
  const double turn = to.load_factor - from.load_factor;
  const double wall_speed = std::abs(wall.scaling.rate * turn) * (wall.displacement.norm() + std::abs(wall.radius_change));
  double least = 1;
  for (const int p : wall.particles) {
    const double speed = u.col(p).norm() + wall_speed, r = model.diameter[p] / 2;
    if (speed == 0) continue;
    const double first = distance(wall, from.load_factor, from.at(p), r);
    if (!std::isfinite(first)) continue;
    const double floor = keep * std::min(first, r);
    double s = 0, here = first;
    for (int k = 0; k < most && s < least; ++k) {
      const double room = here - floor;
      if (room <= 1e-3 * floor && k > 0) break;
      s += room / speed;
      if (s >= least) break;
      ExactVector x = from.at(p);
      x.hi += s * u.col(p);
      here = distance(wall, from.load_factor + s * turn, x, r);
    }
    least = std::min(least, s);
  }
  return least;
}

}  // namespace

double free_passage(const Model& model, const ContactRules& rules, const State& from, const State& to) {
  if (!rules.any() && model.walls.empty()) return 1;
  const Field u = displacement(from, to);
  if (!u.allFinite()) return 0;
  double part = rules.any() ? among_particles(model, rules, from, u) : 1;
  for (const Wall& wall : model.walls)
    if (wall.effective_modulus > 0 || wall.hard) part = std::min(part, at_wall(model, wall, from, to, u));
  return part;
}

}  // namespace elamin
