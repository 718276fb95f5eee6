#include "dynamics/lammps_bodies.hpp"

#include "laws/rounded/rigid_step.hpp"

#include <algorithm>

namespace elamin {

namespace {

Vec3 column(const Field& f, Eigen::Index k) { return k < f.cols() ? Vec3(f.col(k)) : Vec3(Vec3::Zero()); }

BodyMotion motion_of(const BodyRules& rules, int entity, const Model& model, const State& state, const BodyMovement& movement) {
  if (!rules.is_body(entity)) return {column(movement.velocity, entity), Vec3::Zero()};
  const int b = entity - rules.particles();
  const RigidState s{state.bodies[b], column(movement.body_velocity, b), column(movement.angular_momentum, b)};
  return s.motion({model.bodies[b].mass, model.bodies[b].inertia});
}

}  // namespace

std::vector<LammpsWall> lammps_walls(const Wall& wall, double load_factor) {
  std::vector<LammpsWall> walls;
  const Region at = wall.region.moved(wall.scaling.at(load_factor) * wall.displacement, 0);
  for (int axis = 0; axis < 3; ++axis) {
    LammpsWall w{wall.kernel.normal, wall.body_damping.normal, wall.body_damping.tangential, axis};
    if (at.shape == Shape::block) {
      if (!at.open[2 * axis]) w.lo = at.lo[axis];
      if (!at.open[2 * axis + 1]) w.hi = at.hi[axis];
    } else if (at.shape == Shape::plane && at.normal[axis] != 0) {
      ((at.normal[axis] > 0) == wall.inside ? w.lo : w.hi) = at.center[axis];
    }
    if (std::isfinite(w.lo) || std::isfinite(w.hi)) walls.push_back(w);
  }
  return walls;
}

bool follows_lammps(const Model& model) {
  const auto rules = [](const auto& one) {
    if constexpr (requires { one.formulation; }) return one.formulation == RoundedFormulation::lammps;
    else return one.lammps && !one.bodies.empty();
  };
  return std::any_of(model.rounded.begin(), model.rounded.end(), rules) || std::any_of(model.walls.begin(), model.walls.end(), rules);
}

LammpsBodyForces lammps_body_forces(const Model& model, const State& state, const BodyMovement& movement) {
  LammpsBodyForces all;
  all.on.resize(model.bodies.size());
  all.on_particles = Field::Zero(3, model.particles());
  BodyNeighbours neighbours(model);
  neighbours.refresh(state);
  const BodyRules& rules = neighbours.rules();
  std::vector<BodyMotion> motion(rules.entities());
  for (int e = 0; e < rules.entities(); ++e) motion[e] = motion_of(rules, e, model, state, movement);
  const auto add = [&](int entity, const Wrench& w) {
    if (!rules.is_body(entity)) all.on_particles.col(entity) += w.force;
    else all.on[entity - rules.particles()].force += w.force, all.on[entity - rules.particles()].torque += w.torque;
  };
  for (const IndexPair& p : neighbours.pairs()) {
    const auto [i, j] = p;
    const RoundedPair& table = model.rounded[rules.table(i, j)];
    if (table.formulation != RoundedFormulation::lammps) continue;
    ++all.pairs;
    const LammpsPair pair = lammps_rules(table).pair(rules.body(i, state), rules.body(j, state), motion[i], motion[j]);
    all.energy += pair.energy;
    add(i, pair.on[0]), add(j, pair.on[1]);
    if (pair.through) all.through.push_back(p);
    if (pair.overflow) all.overflow.push_back(p);
    if (!pair.conservative()) all.not_conservative.push_back(p);
  }
  for (const Wall& wall : model.walls) {
    if (!wall.lammps || wall.bodies.empty()) continue;
    ++all.walls;
    for (const LammpsWall& w : lammps_walls(wall, state.load_factor))
      for (const int b : wall.bodies) add(rules.particles() + b, w.on(model.body(b, state), motion[rules.particles() + b]));
  }
  return all;
}

}  // namespace elamin
