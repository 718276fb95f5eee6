#include "energy/collision_free_step.hpp"

#include "core/interrupt.hpp"
#include "core/near_pairs.hpp"
#include "energy/body_groups.hpp"
#include "laws/rounded/closest.hpp"
#include "laws/rounded/rotation.hpp"

#include <algorithm>

namespace elamin {

namespace {

constexpr double bodies_keep = 0.2;            // of the distance
constexpr int most_advances = 60;

// How each entity goes: on a straight way, turning evenly.
class Way {
 public:
  Way(const BodyRules& rules, const State& from, const State& to) : rules_(rules), from_(from) {
    const int n = rules.entities(), particles = rules.particles();
    move_.resize(3, n), turn_ = Field::Zero(3, n);
    for (int p = 0; p < particles; ++p) move_.col(p) = (to.at(p) - from.at(p)).hi;
    for (int e = particles; e < n; ++e) {
      const Pose &a = from.bodies[e - particles], &b = to.bodies[e - particles];
      move_.col(e) = (b.position - a.position).hi;
      turn_.col(e) = rotation_between(a.rotation, b.rotation);
    }
  }

  const Field& move() const { return move_; }
  bool stays() const { return move_.isZero(0) && turn_.isZero(0); }
  bool finite() const { return move_.allFinite() && turn_.allFinite(); }
  double turning(int e, const RoundedBody& b) const { return turn_.col(e).norm() * b.shape->extent; }
  RoundedBody at(int e, double s) const {
    RoundedBody b = rules_.body(e, from_);
    b.pose = moved(b.pose, s * move_.col(e), s * turn_.col(e));
    return b;
  }

 private:
  const BodyRules& rules_;
  const State& from_;
  Field move_, turn_;
};

// The part of [0, most] until distance(s), whose rate is `speed` at most, has shrunk to a fifth.
template <class Distance>
double advance(double most, double speed, const Distance& distance) {
  double here = distance(0.0), s = 0;
  if (!(speed > 0) || !(here > 0)) return most;
  const double floor = bodies_keep * here;
  for (int k = 0; k < most_advances && s < most; ++k) {
    const double room = here - floor;
    if (room <= 1e-2 * floor && k > 0) break;
    s += room / speed;
    if (s >= most) return most;
    here = distance(s);
  }
  return std::min(s, most);
}

// The least height of the vertices over a wall; infinity where it sees none.
double height(const RoundedWall& wall, const RoundedBody& body) {
  RoundedWall everywhere = wall;
  everywhere.kernel.cutoff = infinity;
  std::vector<RoundedWallTouch> touches;
  everywhere.touches(body, touches);
  double least = infinity;
  for (const RoundedWallTouch& t : touches) least = std::min(least, t.gap + body.shape->radius);
  return least;
}

double at_walls(const Model& model, const BodyRules& rules, const Way& way, const State& from, const State& to, double part) {
  const double load_change = to.load_factor - from.load_factor;
  for (const Wall& wall : model.walls)
    for (const int b : wall.bodies) {
      if (wall.lammps || wall.kernel.normal == 0) continue;
      const int e = rules.particles() + b;
      const RoundedBody body = model.body(b, from);
      const double speed = (way.move().col(e) - wall.scaling.rate * load_change * wall.displacement).norm() + way.turning(e, body);
      part = std::min(part, advance(part, speed, [&](double s) {
        return height(rounded_wall_at(wall, from.load_factor + s * load_change), way.at(e, s));
      }));
    }
  return part;
}

}  // namespace

double collision_free_body_step(const Model& model, const BodyRules& rules, const State& from, const State& to) {
  if (model.bodies.empty() || (!rules.any() && model.walls.empty())) return 1;
  const Way way(rules, from, to);
  if (!way.finite()) return 0;
  double part = at_walls(model, rules, way, from, to, 1);
  if (!rules.any() || way.stays()) return part;
  Field middle(3, rules.entities());
  std::vector<double> radii(rules.entities(), 0.0);
  for (int e = 0; e < rules.entities(); ++e) {
    middle.col(e) = rules.position(e, from) + way.move().col(e) / 2;
    if (rules.cutoff_radius(e) > 0) radii[e] = rules.cutoff_radius(e) + way.move().col(e).norm() / 2;
  }
  const auto bars = [&](int i, int j) {
    const int t = rules.table(i, j);
    return t >= 0 && model.rounded[t].formulation != RoundedFormulation::lammps && model.rounded[t].kernel.normal > 0;
  };
  for (const auto& [i, j] : near_pairs(middle, radii, bars)) {
    if (interrupted()) return 0;
    const RoundedBody a = way.at(i, 0), b = way.at(j, 0);
    const double speed = (way.move().col(i) - way.move().col(j)).norm() + way.turning(i, a) + way.turning(j, b);
    part = std::min(part, advance(part, speed, [&, a = i, b = j](double s) { return core_separation(way.at(a, s), way.at(b, s)); }));
  }
  return part;
}

}  // namespace elamin
