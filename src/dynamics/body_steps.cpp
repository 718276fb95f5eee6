#include "dynamics/body_steps.hpp"

#include "dynamics/carry.hpp"

#include <algorithm>

namespace elamin {

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
