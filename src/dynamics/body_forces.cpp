#include "dynamics/body_forces.hpp"

#include "dynamics/motion.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "energy/body_groups.hpp"
#include "laws/rounded/closest.hpp"
#include "laws/rounded/multi.hpp"

#include <algorithm>

namespace elamin {

namespace {

RoundedFriction friction_of(const RoundedDamping& d, const RoundedKernel& kernel) {
  return {d.normal, d.tangential, d.friction, kernel.normal, d.slip, d.apart};
}

bool slides(const RoundedDamping& d) { return d.tangential > 0 || (d.friction > 0 && d.slip > 0); }
bool resists(const RoundedDamping& d) { return d.normal > 0 || slides(d); }

// Whether a body about x is so far from every face that no vertex can be near one.
bool far(const RoundedWall& wall, const Vec3& x, double cutoff) {
  cutoff += wall.kernel.cutoff;
  const Region& r = wall.region;
  if (r.shape == Shape::plane) return (wall.inside ? 1 : -1) * r.normal.dot(x - r.center) > cutoff;
  if (r.shape != Shape::block || !wall.inside) return false;
  for (int c = 0; c < 3; ++c)
    if (x[c] - r.lo[c] <= cutoff || r.hi[c] - x[c] <= cutoff) return false;
  return true;
}

}  // namespace

BodyForces::BodyForces(const Model& model, double load_factor) : model_(model), neighbours_(model), state_(model.start) {
  const int bodies = static_cast<int>(model.bodies.size());
  loads_.resize(bodies), on_.resize(bodies), resistance_.resize(bodies), drag_.assign(bodies, 0.0);
  motion_.resize(neighbours_.rules().entities());
  state_.low.setZero(), state_.load_factor = load_factor;
  for (const Load& l : model.loads) {
    const double s = l.scaling.at(load_factor);
    for (const int b : l.bodies) {
      if (l.point.isZero(0)) loads_[b].force += s * l.force;
      else pointed_.push_back({b, s * l.force, l.point});
      if (!l.torque.isZero(0)) twisted_.push_back({b, s, {l.torque, model.start.bodies[b].rotation}});
    }
  }
  for (const Gravity& g : model.gravity)
    for (const int b : g.bodies) loads_[b].force += model.bodies[b].mass * (g.scaling.at(load_factor) * g.acceleration);
  for (const Viscosity& v : model.viscosity)
    for (const int b : v.bodies) drag_[b] += v.coefficient, damps_ = damps_ || v.coefficient != 0;
  std::vector<bool> met(model.particles());
  for (const RoundedPair& t : model.rounded) {
    const bool lammps = t.formulation == RoundedFormulation::lammps, damping = resists(t.damping);
    tables_.push_back({lammps, t.formulation == RoundedFormulation::closest, damping, friction_of(t.damping, t.kernel)});
    damps_ = damps_ || damping;
    for (int side = 0; side < 2; ++side) {
      if (t.particles[side].empty() || t.bodies[1 - side].empty()) continue;
      for (const int p : t.particles[side]) met[p] = true;
      damps_particles_ = damps_particles_ || damping;
      rubs_particles_ = rubs_particles_ || (!lammps && slides(t.damping));
    }
  }
  for (int p = 0; p < model.particles(); ++p)
    if (met[p]) met_.push_back(p);
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const Wall& wall = model.walls[w];
    if (wall.bodies.empty()) continue;
    walls_.push_back({static_cast<int>(w), resists(wall.body_damping), rounded_wall_at(wall, load_factor),
                      friction_of(wall.body_damping, wall.kernel), {}});
    if (wall.lammps) walls_.back().lammps = lammps_walls(wall, load_factor);
    damps_ = damps_ || walls_.back().damps;
  }
}

void BodyForces::find(const BodyPlaces& places, const Movement& movement, Pushes& pushes) {
  const auto& [poses, motion] = places;
  state_.bodies = poses;
  std::copy(motion.begin(), motion.end(), motion_.begin() + model_.particles());
  for (const int p : met_) {
    state_.position.col(p) = vector(movement.position.at(p));
    if (damps_particles_) motion_[p].velocity = vector(movement.velocity.at(p));
    if (rubs_particles_) motion_[p].angular_velocity = vector(movement.angular_velocity.at(p));
  }
  on_ = loads_;
  std::fill(resistance_.begin(), resistance_.end(), Wrench{});
  for (const Pointed& l : pointed_) on_[l.body].add(l.force, poses[l.body].rotation * l.arm);
  for (const Twisted& l : twisted_) on_[l.body].torque -= l.scale * l.torque.derivatives(poses[l.body].rotation).gradient;
  for (std::size_t b = 0; b < drag_.size(); ++b) resistance_[b].force -= drag_[b] * motion[b].velocity;
  meet(pushes);
  touch_walls();
  for (std::size_t b = 0; b < on_.size(); ++b) on_[b].add(resistance_[b]);
}

void BodyForces::put(int entity, const Wrench& elastic, const Wrench& resistance, Pushes& pushes) {
  if (neighbours_.rules().is_body(entity)) {
    const int b = entity - model_.particles();
    on_[b].add(elastic), resistance_[b].add(resistance);
    return;
  }
  pushes.force.add(entity, triple(elastic.force));
  if (damps_particles_) pushes.damping.add(entity, triple(resistance.force));
  if (rubs_particles_) pushes.torque.add(entity, triple(resistance.torque));
}

void BodyForces::list_pairs() {
  const BodyRules& rules = neighbours_.rules();
  pairs_.clear();
  for (const auto& [i, j] : neighbours_.pairs()) pairs_.push_back({i, j, rules.table(i, j), rules.cutoff_radius(i) + rules.cutoff_radius(j)});
}

void BodyForces::carry(Archive& archive) {
  archive(neighbours_, on_, resistance_);
  if (archive.reads()) list_pairs();
}

void BodyForces::meet(Pushes& pushes) {
  const BodyRules& rules = neighbours_.rules();
  if (!neighbours_.covers(state_)) {
    neighbours_.refresh(state_);
    list_pairs();
  }
  const auto position = [&](int e) -> Vec3 {
    return e < model_.particles() ? Vec3(state_.position.col(e)) : state_.bodies[e - model_.particles()].position.hi;
  };
  for (const Pair& p : pairs_) {
    if ((position(p.i) - position(p.j)).squaredNorm() > p.cutoff * p.cutoff) continue;
    const Table& t = tables_[p.table];
    const RoundedPair& table = model_.rounded[p.table];
    const RoundedBody a = rules.body(p.i, state_), b = rules.body(p.j, state_);
    const BodyMotion &va = motion_[p.i], &vb = motion_[p.j];
    std::array<Wrench, 2> elastic, resistance;
    if (t.lammps) {
      const LammpsPair pair = lammps_rules(table).pair(a, b, va, vb);
      elastic = pair.on, resistance = pair.damping;
      for (int k = 0; k < 2; ++k) elastic[k].force -= resistance[k].force, elastic[k].torque -= resistance[k].torque;
    } else {
      contacts_.clear();
      std::vector<RoundedContact>* const contacts = t.damps ? &contacts_ : nullptr;
      elastic = t.closest ? RoundedClosest{table.kernel}.forces(a, b, contacts) : RoundedMulti{table.kernel}.forces(a, b, contacts);
      for (const RoundedContact& c : contacts_) {
        const std::array<Wrench, 2> w = t.friction.at(c, a.pose, b.pose, va, vb);
        resistance[0].add(w[0]), resistance[1].add(w[1]);
      }
    }
    put(p.i, elastic[0], resistance[0], pushes), put(p.j, elastic[1], resistance[1], pushes);
  }
}

void BodyForces::touch_walls() {
  for (const At& w : walls_)
    for (const int b : model_.walls[w.wall].bodies) {
      if (far(w.law, state_.bodies[b].position.hi, model_.shapes[model_.bodies[b].shape].bounding_radius())) continue;
      const RoundedBody body = model_.body(b, state_);
      const BodyMotion& v = motion_[model_.particles() + b];
      if (model_.walls[w.wall].lammps) {
        for (const LammpsWall& plane : w.lammps) {
          Wrench resistance;
          Wrench all = plane.on(body, v, &resistance);
          all.force -= resistance.force, all.torque -= resistance.torque;
          on_[b].add(all), resistance_[b].add(resistance);
        }
        continue;
      }
      touches_.clear();
      w.law.touches(body, touches_);
      for (const RoundedWallTouch& t : touches_) {
        const Vec3 arm = t.point - body.pose.position.hi;
        on_[b].add(t.force * t.normal, arm);
        if (!w.damps) continue;
        RoundedContact c;
        c.gap = t.gap, c.point = t.point + t.gap / 2 * t.normal, c.normal = t.normal;
        resistance_[b].add(w.friction.at(c, body.pose, Pose{}, v, {})[0]);
      }
    }
}

}  // namespace elamin
