#include "dynamics/moving_bodies.hpp"

#include "core/exact.hpp"
#include "dynamics/motion.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

namespace {

struct Freedom {
  std::array<bool, 3> place, turns;
  int axis = -1;                               // the one free turn, if there is one
  bool held = true, turned = false;            // no free coordinate of the place; any free turn

  Freedom(const Kinematics& k, int body) {
    for (int c = 0; c < 3; ++c) {
      place[c] = k.dof(k.place_of(body), c) >= 0, turns[c] = k.dof(k.rotation_of(body), c) >= 0;
      held = held && !place[c];
      if (turns[c]) axis = turned ? -1 : c, turned = true;
    }
  }
};

// The last support that holds a coordinate has it.
Vec3 support_velocity(const Model& model, int body) {
  Vec3 v = Vec3::Zero();
  for (const Support& s : model.supports)
    for (const int b : s.bodies)
      for (int c = 0; c < 3 && b == body; ++c)
        if (s.held[c]) v[c] = s.velocity[c];
  return v;
}

// Whether a held coordinate of the position, when the body turns, moves against the centre of mass.
bool swings(const Freedom& f, const Vec3& arm) {
  if (arm.isZero(0) || !f.turned || f.held) return false;
  for (int c = 0; c < 3; ++c)
    if (!f.place[c] && (f.axis < 0 || (f.axis != c && Vec3::Unit(f.axis).cross(arm).norm() > 1e-12 * arm.norm()))) return true;
  return false;
}

}  // namespace

std::vector<Mistake> MovingBodies::mistakes(const Model& model, const Kinematics& kinematics) {
  std::vector<Mistake> list;
  const auto add = [&](const std::string& key, const std::string& what) { list.push_back({"", 0, 0, key, what}); };
  int massless = 0, last = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Freedom f(kinematics, b);
    const BodyMass m(model, b);
    const std::string name = called(model, model.particles() + b);
    if (!(m.mass > 0) && (!f.held || f.turned)) ++massless, last = b;
    if (swings(f, model.start.bodies[b].rotation * m.center))
      add("glue", fmt::format("the particles that {} carries move its centre of mass, and a support holds its place in some "
                              "directions only while it may turn; "
                              "in dynamics hold all of them, or none, or its turns, or let the particles have no density", name));
    else if (f.held && f.turned && m.loaded && !m.center.isZero(0) && support_velocity(model, b) != Vec3::Zero())
      add("glue", fmt::format("{} carries particles, turns and is driven by a support at a place that is not its centre of "
                              "mass; in dynamics hold its turns too, or drive it with the velocity 0", name));
  }
  if (massless > 0)
    add("mass", fmt::format("{} bod{} can move but {} no mass (the last is {}); dynamics needs a mass or a density", massless,
                            massless > 1 ? "ies" : "y", massless > 1 ? "have" : "has", called(model, model.particles() + last)));
  return list;
}

MovingBodies::MovingBodies(const Model& model, const Kinematics& kinematics, const Motion& start, double timestep) : dt_(timestep) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    const Freedom f(kinematics, b);
    const BodyMass m(model, b);
    const Pose& pose = start.state.bodies[b];
    const bool about_position = f.held || !m.loaded;
    const Vec3 offset = about_position ? Vec3(Vec3::Zero()) : m.center;
    const Mat3 inertia = about_position ? m.inertia : m.inertia_about_center(), R = pose.rotation.toRotationMatrix();
    One one{{pose, start.body_velocity.col(b), start.angular_momentum.col(b)}, RigidMass(m.mass > 0 ? m.mass : 1, inertia), offset, f.place, f.turns,
            Vec3::Zero(), Vec3::Zero(), true, body.inertia, body.mass, 0};
    one.plain = !m.loaded && f.axis < 0 && f.turned && f.turns == std::array{true, true, true};
    if (!one.plain) {
      Vec3 omega = RigidState(one.state).motion({body.mass > 0 ? body.mass : 1, body.inertia}).angular_velocity;
      if (f.turns != std::array{true, true, true}) one.mass.inverse_inertia.setZero();
      if (f.axis >= 0) {
        const Vec3 e = Vec3::Unit(f.axis), own = R.transpose() * e;
        const double moment = own.dot(inertia * own), alone = own.dot(body.inertia * own);
        if (moment > 0) one.mass.inverse_inertia = own * own.transpose() / moment;
        omega = (alone > 0 ? one.state.angular_momentum[f.axis] / alone : 0.0) * e;
        one.state.angular_momentum = moment * omega;
      } else if (f.turned) {
        one.state.angular_momentum = R * (inertia * (R.transpose() * omega));
      } else {
        omega.setZero(), one.state.angular_momentum.setZero();
      }
      if (!offset.isZero(0)) {
        const Vec3 arm = R * offset;
        one.state.pose.position = pose.position + ExactVector{arm, Vec3::Zero()};
        one.state.velocity += omega.cross(arm);
      }
      for (const Glued& g : model.glued)
        if (g.body == b) one.carried_inertia += 0.1 * model.mass(g.particle) * model.diameter[g.particle] * model.diameter[g.particle];
    }
    one.velocity = support_velocity(model, b);
    one.start = one.state.pose.position.hi + one.state.pose.position.lo;
    for (int c = 0; c < 3; ++c) {
      if (f.place[c]) one.velocity[c] = 0;
      else one.state.velocity[c] = one.velocity[c];
      driven_ = driven_ || one.velocity[c] != 0;
    }
    bodies_.push_back(one);
  }
}

void MovingBodies::kick(const std::vector<Wrench>& on) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    One& one = bodies_[b];
    Wrench w = on[b];
    if (!one.offset.isZero(0)) w.torque -= Vec3(one.state.pose.rotation * one.offset).cross(w.force);
    for (int c = 0; c < 3; ++c) {
      if (!one.free[c]) w.force[c] = 0;
      if (!one.turns[c]) w.torque[c] = 0;
    }
    elamin::kick(one.state, one.mass, w, dt_);
  }
}

void MovingBodies::carry(Archive& archive) {
  for (One& one : bodies_) archive(one.state);
}

void MovingBodies::drift() {
  for (One& one : bodies_) elamin::drift(one.state, one.mass, dt_);
}

void MovingBodies::place_driven(double time) {
  for (One& one : bodies_)
    for (int c = 0; c < 3 && driven_; ++c)
      if (one.velocity[c] != 0) one.state.pose.position.set(c, Exact{one.start[c] + one.velocity[c] * time});
}

void MovingBodies::show(BodyPlaces& places) const {
  places.pose.resize(bodies_.size()), places.motion.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const One& one = bodies_[b];
    places.pose[b] = one.state.pose, places.motion[b] = one.state.motion(one.mass);
    if (one.offset.isZero(0)) continue;
    const Vec3 arm = one.state.pose.rotation * one.offset;
    places.pose[b].position = one.state.pose.position + ExactVector{-arm, Vec3::Zero()};
    places.motion[b].velocity -= places.motion[b].angular_velocity.cross(arm);
  }
}

double MovingBodies::work_rate(const std::vector<Wrench>& on) const {
  double rate = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) rate -= on[b].force.dot(bodies_[b].velocity);
  return rate;
}

double MovingBodies::kinetic(const BodyPlaces& now) const {
  ExactSum sum;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const One& one = bodies_[b];
    const Vec3& w = now.motion[b].angular_velocity;
    sum.add(one.own_mass / 2 * now.motion[b].velocity.squaredNorm());
    if (one.plain) {
      sum.add(w.dot(one.state.angular_momentum) / 2);
      continue;
    }
    const Vec3 own = now.pose[b].rotation.conjugate() * w;
    sum.add(own.dot(one.own_inertia * own) / 2 + one.carried_inertia / 2 * w.squaredNorm());
  }
  return sum.value();
}

void MovingBodies::write(const BodyPlaces& now, Motion& motion) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const One& one = bodies_[b];
    motion.state.bodies[b] = now.pose[b];
    motion.body_velocity.col(b) = now.motion[b].velocity;
    if (one.plain) {
      motion.angular_momentum.col(b) = one.state.angular_momentum;
      continue;
    }
    const Mat3 R = now.pose[b].rotation.toRotationMatrix();
    motion.angular_momentum.col(b) = R * (one.own_inertia * (R.transpose() * now.motion[b].angular_velocity));
  }
}

namespace {
Lanes lanes(const Vec3& a) { return {a[0], a[1], a[2], 0}; }
}  // namespace

BodySteps::BodySteps(const Model& model, const Kinematics& kinematics, const Motion& start, double timestep, Forces& forces,
                     MovingParticles particles)
    : model_(model), dt_(timestep), forces_(forces), at_(particles), bodies_(model, kinematics, start, timestep) {}

double BodySteps::carry() {
  bodies_.show(places());
  double fastest = 0;
  for (const Glued& g : model_.glued) {
    const int p = g.particle;
    const Pose& pose = places().pose[g.body];
    const BodyMotion& motion = places().motion[g.body];
    const Vec3 arm = pose.rotation * g.arm, x = pose.position.hi + arm, v = motion.at(arm);
    fastest = std::max(fastest, (x - at_.x.at(p)).squaredNorm() / (dt_ * dt_));
    for (int c = 0; c < 3; ++c) at_.x.at(c, p) = x[c], at_.v.at(c, p) = v[c];
    if (!forces_.by_row()) continue;
    Movement& m = forces_.movement();
    m.position.row[p] = lanes(x);
    if (forces_.damped()) m.velocity.row[p] = lanes(v);
    if (forces_.rubs()) m.angular_velocity.row[p] = lanes(motion.angular_velocity);
  }
  return fastest;
}

double BodySteps::look() {
  gather();
  return -power();
}

void BodySteps::start() {
  bodies_.kick(wrench_);
  bodies_.drift();
}

double BodySteps::place(double time) {
  bodies_.place_driven(time);
  return carry();
}

double BodySteps::finish(bool last) {
  gather();
  bodies_.kick(wrench_);
  bodies_.show(places());
  double taken = -power();
  for (const Glued& g : model_.glued) {
    const int p = g.particle;
    const BodyMotion& now = places().motion[g.body];
    Vec3 resistance = -at_.drag[p] * at_.v.at(p);
    if (forces_.damped()) resistance += vector(forces_.damping_at(p));
    taken -= resistance.dot(now.at(places().pose[g.body].rotation * g.arm) - at_.v.at(p));
    if (forces_.rubs()) taken -= torque_at(p).dot(now.angular_velocity - vector(forces_.movement().angular_velocity.at(p)));
  }
  if (last) carry();
  else start();
  return taken;
}

void BodySteps::carry(Archive& archive) { archive(bodies_, wrench_); }

void BodySteps::gather() {
  wrench_ = forces_.bodies()->on();
  for (const Glued& g : model_.glued) {
    wrench_[g.body].add(at_.f.at(g.particle), places().pose[g.body].rotation * g.arm);
    if (forces_.rubs()) wrench_[g.body].torque += torque_at(g.particle);
  }
}

double BodySteps::power() const {
  double sum = 0;
  for (std::size_t b = 0; b < wrench_.size(); ++b) sum += forces_.bodies()->resistance()[b].power(places().motion[b]);
  return sum;
}

Vec3 BodySteps::torque_at(int p) const {
  const Lanes t = forces_.torque_on(p);
  return {t[0], t[1], t[2]};
}

bool BodySteps::finite() const {
  return std::all_of(places().pose.begin(), places().pose.end(),
                     [](const Pose& p) { return p.position.hi.allFinite() && p.rotation.coeffs().allFinite(); });
}

void BodySteps::write(Motion& motion) const {
  bodies_.write(places(), motion);
  for (std::size_t b = 0; b < wrench_.size(); ++b)
    motion.body_force.col(static_cast<Eigen::Index>(b)) = wrench_[b].force, motion.torque.col(static_cast<Eigen::Index>(b)) = wrench_[b].torque;
}

}  // namespace elamin
