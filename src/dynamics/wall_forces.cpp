#include "dynamics/wall_forces.hpp"

#include "energy/wall_group.hpp"
#include "laws/hertz_contact.hpp"

namespace elamin {

namespace {

// On the axis or in the centre of a round wall, where it has no direction.
bool central(const Region& region, const Vec3& x) {
  if (region.shape == Shape::plane || region.shape == Shape::block) return false;
  Vec3 y = x - region.center;
  if (region.shape != Shape::sphere) y[region.axis] = 0;
  return y.isZero(0);
}

}  // namespace

WallForces::WallForces(const Model& model, double load_factor, double skin) : model_(model), skin_(skin) {
  for (const Wall& w : model.walls) {
    walls_.push_back(wall_at(w, load_factor));
    walls_.back().region = walls_.back().region.rounded();
    const bool damps = w.damping.model != ContactDamping::Model::none && w.damping.coefficient > 0;
    damped_ = damped_ || damps;
    rubs_ = rubs_ || (damps && w.damping.tangential > 0 && w.damping.friction > 0);
  }
}

void WallForces::find(const Columns& x) {
  near_.clear();
  std::array<WallPress, WallContact::most_faces> presses;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    WallContact wall = walls_[w];
    wall.curved = false;
    // A sphere larger by the skin overlaps whatever the particle may touch before it has moved by half of it.
    for (const int p : model_.walls[w].particles) {
      const Vec3 at = x.at(p);
      if (wall.presses(at, model_.diameter[p] / 2 + skin_, presses) != 0 || central(wall.region, at))
        near_.push_back({static_cast<int>(w), p});
    }
  }
}

void WallForces::add(const Movement& movement, Pushes& pushes) {
  std::array<WallPress, WallContact::most_faces> presses;
  for (const Near& n : near_) {
    const Triple<double> at = movement.position.at(n.particle);
    const Vec3 x(at.x, at.y, at.z);
    const WallContact& wall = walls_[n.wall];
    const int count = wall.presses(x, model_.diameter[n.particle] / 2, presses);
    if (count <= 0) continue;
    Vec3 f = wall.curving_force(x, model_.diameter[n.particle] / 2);
    for (int k = 0; k < count; ++k) {
      const double stiffness = wall.effective_modulus * 4 / 3 * std::sqrt(presses[k].effective_radius);
      f += HertzContact::push(presses[k].overlap, stiffness) * presses[k].normal;
      if (model_.walls[n.wall].damping.model != ContactDamping::Model::none) damp(n, presses[k], stiffness, movement, pushes);
    }
    pushes.force.add(n.particle, triple(f));
  }
}

void WallForces::damp(const Near& near, const WallPress& press, double stiffness, const Movement& movement, Pushes& pushes) const {
  if (!pushes.damped()) return;
  const double r = model_.diameter[near.particle] / 2;
  const DampedContact d(model_.walls[near.wall].damping, model_.mass(near.particle), stiffness, press.effective_radius);
  const Triple<double> n = triple(press.normal), v = movement.velocity.at(near.particle);
  const double along = dot(v, n), eta = damping_coefficient(press.overlap, d.coefficient, d.roots);
  Triple<double> f = (-eta * along) * n;
  if (d.rubs()) {
    const double normal = HertzContact::push(press.overlap, stiffness) - eta * along;
    const Triple<double> rub = friction(n, v, along, r * movement.angular_velocity.at(near.particle), normal, d.tangential * eta, d.friction);
    f = f + rub;
    pushes.torque.add(near.particle, -r * cross(n, rub));
  }
  pushes.damping.add(near.particle, f);
}

}  // namespace elamin
