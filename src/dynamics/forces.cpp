#include "dynamics/forces.hpp"

#include "dynamics/motion.hpp"
#include "energy/groups.hpp"

#include <algorithm>

namespace elamin {

OtherForces::OtherForces(const Model& model, const EdgeOrder& order, double load_factor) : part_(model), state_(model.start) {
  part_.bonds.clear(), part_.angles.clear(), part_.glued.clear();   // a force on a glued particle is one on the particle
  for (const int b : order.bonds) part_.bonds.push_back(model.bonds[b]);
  for (const int a : order.angles) part_.angles.push_back(model.angles[a]);
  state_.low.setZero();
  state_.load_factor = load_factor;
  const Kinematics kinematics(part_);
  groups_.push_back(bond_group(part_, kinematics).free);
  groups_.push_back(angle_group(part_, kinematics).free);
  groups_.push_back(pressure_group(part_));
  groups_.push_back(sheet_pressure_group(part_));
  for (const auto& g : groups_) {
    value_.resize(std::max<std::size_t>(value_.size(), g->elements()));
    gradient_.resize(std::max<std::size_t>(gradient_.size(), std::size_t(g->elements()) * g->gradient_size()));
  }
}

void OtherForces::add(const Columns& x, Rows& force) {
  x.copy_to(state_.position);
  for (const auto& group : groups_) {
    group->derivatives(state_, {}, value_.data(), gradient_.data(), nullptr);
    const double* g = gradient_.data();
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e)) force.row[p] -= Lanes(g[0], g[1], g[2], 0), g += 3;
  }
}

namespace {

constexpr double skin_of_diameter = 0.35;
constexpr double used_up = 0.8;                 // part of half the skin, moved by, at which the lists are made anew

double skin_for(const Model& model, const ContactRules* rules) {
  double smallest = infinity;
  if (rules)
    for (int i = 0; i < model.particles(); ++i)
      if (rules->cutoff_radius(i) > 0) smallest = std::min(smallest, 2 * rules->cutoff_radius(i));
  for (const Wall& w : model.walls)
    for (const int p : w.particles) smallest = std::min(smallest, model.diameter[p]);
  return skin_of_diameter * smallest;
}

}  // namespace

Forces::Forces(const Model& model, double load_factor)
    : Forces(model, load_factor, order_edges(model, load_factor)) {}

Forces::Forces(const Model& model, double load_factor, const EdgeOrder& order)
    : particles_(model.particles()), edges_(order, model.particles()), loads_(model.particles()) {
  for (const Load& l : model.loads)
    for (std::size_t k = 0; k < l.particles.size(); ++k)
      for (int c = 0; c < 3; ++c) loads_.at(c, l.particles[k]) += l.scaling.at(load_factor) * l.on(k)[c];
  for (const Gravity& g : model.gravity)
    for (const int p : g.particles)
      for (int c = 0; c < 3; ++c) loads_.at(c, p) += model.mass(p) * (g.scaling.at(load_factor) * g.acceleration[c]);
  for (const Pressure& p : model.pressures)
    for (std::size_t k = 0; p.rim.size() && k < p.particles.size(); ++k)
      for (int c = 0; c < 3; ++c)
        loads_.at(c, p.particles[k]) += p.scaling.at(load_factor) * p.pressure * p.rim(c, static_cast<Eigen::Index>(k));
  loaded_ = !model.loads.empty() || !model.gravity.empty() || !model.pressures.empty();
  if (OtherForces::needed(model, order)) others_.emplace(model, order, load_factor);
  if (!model.contacts.empty()) rules_.emplace(model);
  skin_ = skin_for(model, rules_ ? &*rules_ : nullptr);
  if (rules_) pairs_.emplace(model, *rules_, skin_);
  if (!model.walls.empty()) walls_.emplace(model, load_factor, skin_);
  if (!model.bodies.empty()) bodies_.emplace(model, load_factor);
  by_row_ = pairs_ || walls_ || (bodies_ && bodies_->meets_particles());
  const int n = model.particles();
  if (by_row_) movement_.position = Rows(n), listed_ = Columns(n);
  if (by_row_ || others_) pushes_.force = Rows(n);
  const bool rub = (pairs_ && pairs_->rubs()) || (walls_ && walls_->rubs()) || (bodies_ && bodies_->rubs_particles());
  if (rub || (pairs_ && pairs_->damped()) || (walls_ && walls_->damped()) || (bodies_ && bodies_->damps_particles()))
    pushes_.damping = movement_.velocity = Rows(n);
  if (rub) pushes_.torque = movement_.angular_velocity = Rows(n);
  travelled_ = infinity;
}

double Forces::farthest(const Columns& x) const {
  Lanes most(0.0);
  for (int i = 0; i < particles_; i += 4) {
    const Triple<Lanes> d = x.load(i) - listed_.load(i);
    most = max(dot(d, d), most);
  }
  return std::sqrt(most.largest());
}

void Forces::find_near(const Columns& x) {
  if (!(travelled_ > skin_ / 2)) return;
  if (std::isfinite(travelled_)) {
    travelled_ = farthest(x);
    if (travelled_ <= used_up * skin_ / 2) return;
  }
  listed_ = x;
  travelled_ = 0;
  if (pairs_) pairs_->find(x);
  if (walls_) walls_->find(x);
}

void Forces::carry(Archive& archive) {
  archive(travelled_, listed_, places_.pose, places_.motion);
  for (Rows* rows : {&movement_.position, &movement_.velocity, &movement_.angular_velocity, &pushes_.force, &pushes_.damping, &pushes_.torque}) archive(*rows);
  if (bodies_) archive(*bodies_);
  if (!archive.reads() || !std::isfinite(travelled_)) return;
  if (pairs_) pairs_->find(listed_);
  if (walls_) walls_->find(listed_);
}

void Forces::prepare(const Columns& x) {
  edges_.begin();
  if (pushes()) push(x);
  if (bodies_) bodies_->find(places_, movement_, pushes_);
}

void Forces::push(const Columns& x) {
  pushes_.force.clear(), pushes_.damping.clear(), pushes_.torque.clear();
  if (by_row_) {
    find_near(x);
    if (pairs_) pairs_->add(movement_, pushes_);
    if (walls_) walls_->add(movement_, pushes_);
  }
  if (others_) others_->add(x, pushes_.force);
}

}  // namespace elamin
