#include "energy/collision_free_step.hpp"

#include "core/interrupt.hpp"
#include "core/near_pairs.hpp"
#include "energy/wall_group.hpp"
#include "laws/frustum.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace elamin {

namespace {

constexpr double particles_keep = 0.8;         // of the distance, at least
constexpr double chunk = 10;                   // movement looked at in one go, in smallest distances of touch
constexpr double most_pieces = 100;            // looked at: a step of a thousand such distances is no step to an equilibrium nearby

// Distance at which a pair touches; 0: it feels nothing.
double touching(const Model& model, const ContactRules& rules, int i, int j) {
  if (const int t = rules.hertz(i, j); t >= 0 && (model.contacts[t].effective_modulus > 0 || model.contacts[t].hard))
    return (model.diameter[i] + model.diameter[j]) / 2;
  const int t = rules.lj(i, j);
  return t >= 0 && model.contacts[t].epsilon > 0 ? model.contacts[t].sigma : 0;
}

// The smaller root s > 0 of |d + s u| = floor < |d|; infinity: it stays away.
double smaller_root(const Vec3& d, const Vec3& u, double floor) {
  const double a = u.squaredNorm(), b = d.dot(u), c = d.squaredNorm() - floor * floor, discriminant = b * b - a * c;
  if (!(b < 0) || discriminant < 0) return infinity;
  return c / (-b + std::sqrt(discriminant));
}

double among_particles(const Model& model, const Neighbours& neighbours, const State& from, const State& to, const Field& u) {
  const ContactRules& rules = neighbours.rules();
  const auto free_part = [&](const IndexPair& pair) {
    const auto [i, j] = pair;
    const double touch = touching(model, rules, i, j);
    if (touch == 0) return infinity;
    const Vec3 d = (from.at(j) - from.at(i)).hi;
    return smaller_root(d, u.col(j) - u.col(i), particles_keep * std::min(d.norm(), touch));
  };
  if (neighbours.covers(from) && neighbours.covers(to)) {       // then on the whole way
    double least = 1;
    for (const auto* list : {&neighbours.hertz(), &neighbours.lj(), &neighbours.hard()})
      for (const IndexPair& pair : *list) least = std::min(least, free_part(pair));
    return least;
  }
  double fastest = 0, smallest = infinity;
  for (int i = 0; i < model.particles(); ++i)
    if (rules.cutoff_radius(i) > 0) fastest = std::max(fastest, u.col(i).norm()), smallest = std::min(smallest, 2 * rules.cutoff_radius(i));
  if (fastest == 0) return 1;
  const double width = std::min(1.0, chunk * smallest / fastest), looked_at = std::min(1.0, most_pieces * width);
  std::vector<double> radii(model.particles(), 0.0);
  for (int piece = 0; piece * width < looked_at; ++piece) {
    const double begin = piece * width;
    if (begin > 0 && interrupted()) return begin;
    for (int i = 0; i < model.particles(); ++i)
      if (rules.cutoff_radius(i) > 0) radii[i] = rules.cutoff_radius(i) + width / 2 * u.col(i).norm();
    double least = infinity;
    for (const IndexPair& pair : near_pairs(from.position + (begin + width / 2) * u, radii, [&](int p, int q) { return touching(model, rules, p, q) > 0; }))
      least = std::min(least, free_part(pair));
    if (least <= begin + width) return std::min(looked_at, least);
  }
  return looked_at;
}

// Distance of the particle's centre to the wall's surface; infinity where the wall does not see it.
double distance(const Wall& wall, double load_factor, const ExactVector& x, double r) {
  constexpr double aside = 1e-9;                                 // in radii: on an axis or at a centre a curved wall has no direction
  constexpr double far = infinity;
  const WallContact now = wall_at(wall, load_factor);
  const auto nearest = [&](const ExactVector& at) {
    std::array<WallTouch, WallContact::most_faces> faces;
    const int n = now.touches(at, r, far, faces);
    double least = far;
    for (int k = 0; k < n; ++k) least = std::min(least, faces[k].gap + r);
    return least;
  };
  const double here = nearest(x);
  if (std::isfinite(here) || !on_side(now.region, now.inside, x)) return here;
  return nearest(ExactVector{x.hi + aside * r * Vec3::Ones(), x.lo});
}

// The part of the way that the centre of particle p may go, `most` at the most; `speed`: no less than any of its approaches; `begin`: the wall's region at the beginning of the way.
double at_wall(const Model& model, const Wall& wall, const Region& begin, int p, const State& from, double load_change, const Vec3& u, double speed, double most) {
  constexpr int most_parts = 200;
  constexpr double on_surface = 1e-9, off_surface = 1e-6;        // in radii
  const double r = model.diameter[p] / 2;
  const auto room_at = [&](double distance) { return distance - particles_keep * std::min(distance, r); };
  if (room_at(begin.least_distance(from.at(p).hi)) > speed * most) return most;
  const auto at = [&](double s) {
    ExactVector x = from.at(p);
    x.hi += s * u;
    return distance(wall, from.load_factor + s * load_change, x, r);
  };
  double here = at(0), s = 0;
  if (!(speed > 0) || !std::isfinite(here)) return most;
  if (here <= on_surface * r) {                                  // no distance to live on: it may leave, or slide along what is flat
    const double first = here;
    s = std::min(most, off_surface * r / speed), here = at(s);
    if (here == first) return most;
    if (!(here > first) || !std::isfinite(here)) return 0;
  }
  const double floor = particles_keep * std::min(here, r);
  for (int k = 0; k < most_parts && s < most; ++k) {
    const double room = here - floor;
    if (room <= 1e-3 * floor && k > 0) break;
    s += room / speed;
    if (s < most) here = at(s);
  }
  return std::min(s, most);
}

double at_wall(const Model& model, const Wall& wall, const State& from, const State& to, const Field& u) {
  const double load_change = to.load_factor - from.load_factor;
  const double wall_speed = std::abs(wall.scaling.rate * load_change) * (wall.displacement.norm() + std::abs(wall.radius_change));
  const Region begin = wall_at(wall, from.load_factor).region;
  double least = 1;
  for (const int p : wall.particles) least = at_wall(model, wall, begin, p, from, load_change, u.col(p), u.col(p).norm() + wall_speed, least);
  return least;
}

}  // namespace

double collision_free_particle_step(const Model& model, const Neighbours& neighbours, const State& from, const State& to) {
  const bool pairs = neighbours.rules().any();
  if (!pairs && model.walls.empty()) return 1;
  const Field u = displacement(from, to);
  if (!u.allFinite()) return 0;
  double part = pairs ? among_particles(model, neighbours, from, to, u) : 1;
  for (const Wall& wall : model.walls)
    if (wall.effective_modulus > 0 || wall.hard) part = std::min(part, at_wall(model, wall, from, to, u));
  return part;
}

}  // namespace elamin
