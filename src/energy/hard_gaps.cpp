#include "energy/hard_gaps.hpp"

#include "energy/wall_group.hpp"
#include "laws/hard_contact.hpp"

#include <algorithm>

namespace elamin {

namespace {

void between_particles(const Model& model, int i, int j, const State& state, HardGap& gap) {
  const HardContact law{-1, (model.diameter[i] + model.diameter[j]) / 2};      // f = −1: U is the gap
  const Points<2> x = points<2>(state, {i, j});
  const Local<2> c = law.derivatives(x);
  gap.sites = 2, gap.site = {i, j};
  gap.value = c.value, gap.gradient = c.gradient, gap.hessian = c.hessian;
  gap.point = x.position.col(0) + (model.diameter[i] / 2 + c.value / 2) * c.gradient.tail<3>();
}

bool at_wall(const Model& model, const HardForce& contact, const State& state, HardGap& gap) {
  const Wall& wall = model.walls[contact.wall];
  const double r = model.diameter[contact.particle] / 2;
  const HardWall law{-1, wall_at(wall, state.load_factor).region, wall.inside, r, contact.face};
  const Points<1> x = points<1>(state, {contact.particle});
  WallGap g;
  if (!law.find(x, g)) return false;
  gap.sites = 1, gap.site = {contact.particle, -1};
  gap.value = -g.overlap;
  const Vec3 n = g.distance.gradient.head<3>();
  gap.gradient.setZero(), gap.hessian.setZero();
  gap.gradient.head<3>() = n;
  gap.hessian.topLeftCorner<3, 3>() = g.distance.hessian.topLeftCorner<3, 3>();
  gap.point = x.position.col(0) - g.distance.value * n;
  gap.rate = wall.scaling.rate * (wall.radius_change * g.distance.gradient[3] - n.dot(wall.displacement));
  gap.gradient_rate = wall.scaling.rate * (wall.radius_change * g.distance.hessian.topRightCorner<3, 1>() -
                                           g.distance.hessian.topLeftCorner<3, 3>() * wall.displacement);
  return true;
}

}  // namespace

bool any_hard(const Model& model) {
  return std::any_of(model.contacts.begin(), model.contacts.end(), [](const PairContact& c) { return c.hard; }) ||
         std::any_of(model.walls.begin(), model.walls.end(), [](const Wall& w) { return w.hard; });
}

std::array<int, 4> key(const HardForce& h) { return {h.wall, h.particle, h.other, h.face}; }

bool hard_gap(const Model& model, const HardForce& contact, const State& state, HardGap& gap) {
  if (contact.wall >= 0) return at_wall(model, contact, state, gap);
  gap.rate = 0, gap.gradient_rate.setZero();
  between_particles(model, contact.particle, contact.other, state, gap);
  return true;
}

std::vector<HardForce> hard_candidates(const Model& model, const Neighbours& neighbours, const State& state, double step_bound) {
  std::vector<HardForce> found;
  for (const auto& [i, j] : neighbours.hard()) found.push_back({i, j, -1, -1, 0});
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const Wall& wall = model.walls[w];
    if (!wall.hard) continue;
    const Region now = wall_at(wall, state.load_factor).region;
    for (const int p : wall.particles)
      for (const WallGap& g : wall_gaps(now, wall.inside, false, state.at(p), model.diameter[p] / 2, step_bound))
        found.push_back({p, -1, static_cast<int>(w), g.face, 0});
  }
  const auto before = [](const HardForce& a, const HardForce& b) { return key(a) < key(b); };
  std::sort(found.begin(), found.end(), before);
  for (const HardForce& h : state.hard)
    if (const auto at = std::lower_bound(found.begin(), found.end(), h, before); at != found.end() && key(*at) == key(h)) at->force = h.force;
  return found;
}

}  // namespace elamin
