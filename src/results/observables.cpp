#include "results/observables.hpp"

#include "core/error.hpp"
#include "laws/rounded/rigid_step.hpp"
#include "laws/rounded/rotation.hpp"
#include "model/entities.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace elamin {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double component(const Vec3& v, Component c) {
  switch (c) {
    case Component::x: return v[0];
    case Component::y: return v[1];
    case Component::z: return v[2];
    case Component::norm: return v.stableNorm();
  }
  return 0;
}

/// Bears a force as a hard contact does, or overlaps by more than rounding: what an event has located as touching is not closed, whichever sign its gap has.
bool closed(const Model& model, const Touch& t) {
  constexpr double rounding = 1e-12;                  // of the size
  return t.bears || t.gap < -rounding * size_of(model, t.particle);
}

bool scalar(Quantity q) { return q == Quantity::gap || q == Quantity::contacts; }
bool of_bodies(Quantity q) { return q == Quantity::rotation || q == Quantity::torque || q == Quantity::spin; }
Vec3 as_vector(double scalar) { return {scalar, 0, 0}; }

/// One number of many; a scalar quantity stands in x.
double reduced(const std::vector<Vec3>& values, Component c, Reduce reduce) {
  double least = infinity, most = -infinity;
  ExactSum all;
  ExactSum sums[3];
  for (const Vec3& v : values) {
    const double value = component(v, c);
    least = std::min(least, value), most = std::max(most, value);
    all.add(value);
    for (int d = 0; d < 3; ++d) sums[d].add(v[d]);
  }
  switch (reduce) {
    case Reduce::min: return least;
    case Reduce::max: return most;
    case Reduce::mean: return all.value() / static_cast<double>(values.size());
    case Reduce::sum: return component({sums[0].value(), sums[1].value(), sums[2].value()}, c);
  }
  return 0;
}

/// ω = R I⁻¹ Rᵀ L.
Vec3 spin_of(const Body& body, const Pose& pose, const Vec3& momentum) {
  return pose.rotation * (RigidMass(body.mass, body.inertia).inverse_inertia * (pose.rotation.conjugate() * momentum));
}

}  // namespace

Observables::Observables(const Problem& problem, const Model& model)
    : problem_(problem), model_(model), held_(decltype(held_)::Constant(3, model.particles() + 2 * static_cast<int>(model.bodies.size()), false)) {
  std::vector<Mistake> mistakes;
  const auto wrong = [&](const ObserveTable& o, const char* key, const std::string& what) {
    mistakes.push_back({problem.file, o.place.line, o.place.column, key, what});
  };
  for (const ObserveTable& o : problem.observe) {
    Subject subject;
    const auto take = [&](const auto& of, int wall) {
      if (subject.known) return;
      subject.known = true, subject.wall = wall;
      if (!of_bodies(o.quantity)) subject.entities = of.particles;
      for (const int body : of.bodies) subject.entities.push_back(model.particles() + body);
    };
    for (const Group& g : model.groups)
      if (g.name == o.group) take(g, -1);
    for (std::size_t w = 0; w < model.walls.size(); ++w)
      if (model.walls[w].name == o.group) take(model.walls[w], static_cast<int>(w));
    if (!subject.known) {
      std::string known;
      for (const Group& g : model.groups) known += (known.empty() ? "" : ", ") + g.name;
      for (const Wall& w : model.walls) known += ", " + w.name;
      wrong(o, "observe.group", "there is no group \"" + o.group + "\"; there are " + known);
    } else if (subject.wall >= 0 && o.quantity != Quantity::reaction && !scalar(o.quantity)) {
      wrong(o, "observe.quantity", "\"" + o.group + "\" is a wall; it has a reaction, gap and contacts only");
    } else if (subject.entities.empty() && subject.wall < 0) {
      wrong(o, "observe.group", of_bodies(o.quantity) ? "the group \"" + o.group + "\" has no body; particles have no rotation, torque and spin"
                                                      : "the group \"" + o.group + "\" has no particle and no body; at least one is needed");
    }
    subjects_.push_back(subject);
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  const auto hold = [&](int site, const std::array<bool, 3>& held) {
    for (int c = 0; c < 3; ++c) held_(c, site) = held_(c, site) || held[c];
  };
  for (const Support& s : model.supports) {
    for (const int i : s.particles) hold(i, s.held);
    for (const int b : s.bodies) hold(model.particles() + 2 * b, s.held), hold(model.particles() + 2 * b + 1, s.turns_held);
  }
}

std::vector<std::string> Observables::names() const {
  std::vector<std::string> all;
  for (const ObserveTable& o : problem_.observe) all.push_back(o.name);
  return all;
}

bool Observables::sufficient(const std::vector<Touch>& touches) const {
  for (std::size_t k = 0; k < subjects_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    if (o.quantity != Quantity::gap) continue;
    const std::vector<double> all = gaps(subjects_[k].wall, touches);
    const auto known = [&](int i) { return all[i] < infinity; };
    const std::vector<int>& of = subjects_[k].entities;
    if (o.reduce == Reduce::min ? std::none_of(of.begin(), of.end(), known)
                                : !std::all_of(of.begin(), of.end(), known))
      return false;
  }
  return true;
}

std::vector<double> Observables::evaluate(const State& state, const Field& forces, const std::vector<Touch>& touches,
                                          const Motion* moving) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < subjects_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    const Subject& subject = subjects_[k];
    const std::vector<Vec3> all = subject.wall >= 0 ? of_wall(o, subject, touches) : of_group(o, subject, state, forces, touches, moving);
    values.push_back(reduced(all, scalar(o.quantity) ? Component::x : o.component, o.reduce));
  }
  return values;
}

std::vector<Vec3> Observables::of_group(const ObserveTable& o, const Subject& subject, const State& state,
                                        const Field& forces, const std::vector<Touch>& touches, const Motion* moving) const {
  std::vector<double> scalars;                        // of all entities
  if (o.quantity == Quantity::gap) scalars = gaps(-1, touches);
  if (o.quantity == Quantity::contacts) {
    scalars.resize(entities(model_));
    for (const Touch& t : touches)
      if (closed(model_, t)) {
        ++scalars[t.particle];
        if (t.other >= 0) ++scalars[t.other];
      }
  }
  std::vector<Vec3> values;
  for (const int e : subject.entities) {
    if (scalar(o.quantity)) values.push_back(as_vector(scalars[e]));
    else if (is_body(model_, e)) values.push_back(of_body(o.quantity, e - model_.particles(), state, forces, moving));
    else values.push_back(of_particle(o.quantity, e, state, forces, moving));
  }
  return values;
}

Vec3 Observables::of_particle(Quantity q, int i, const State& state, const Field& forces, const Motion* moving) const {
  if (q == Quantity::position) return state.position.col(i);
  if (q == Quantity::displacement) {
    const ExactVector d = state.at(i) - model_.start.at(i);
    return d.hi + d.lo;
  }
  if (q == Quantity::reaction) return held_.col(i).select(-forces.col(i), Vec3::Zero());
  const Field& velocity = moving ? moving->velocity : model_.velocity;
  return velocity.cols() > 0 ? Vec3(velocity.col(i)) : Vec3(Vec3::Zero());
}

Vec3 Observables::of_body(Quantity q, int b, const State& state, const Field& forces, const Motion* moving) const {
  const Pose &pose = state.bodies[b], &start = model_.start.bodies[b];
  const int place = model_.particles() + 2 * b, turn = place + 1;
  const Field &velocity = moving ? moving->body_velocity : model_.body_velocity, &momentum = moving ? moving->angular_momentum : model_.angular_momentum;
  switch (q) {
    case Quantity::position: return pose.position.hi + pose.position.lo;
    case Quantity::displacement: {
      const ExactVector d = pose.position - start.position;
      return d.hi + d.lo;
    }
    case Quantity::rotation: return rotation_vector(pose.rotation * start.rotation.conjugate());
    case Quantity::reaction: return held_.col(place).select(-forces.col(place), Vec3::Zero());
    case Quantity::torque:
      return held_.col(turn).select(-size_of(model_, model_.particles() + b) / 2 * forces.col(turn), Vec3::Zero());
    case Quantity::velocity: return velocity.cols() > 0 ? Vec3(velocity.col(b)) : Vec3(Vec3::Zero());
    case Quantity::spin: return momentum.cols() > 0 ? spin_of(model_.bodies[b], pose, momentum.col(b)) : Vec3(Vec3::Zero());
    case Quantity::gap:
    case Quantity::contacts: break;
  }
  return Vec3::Zero();
}

std::vector<Vec3> Observables::of_wall(const ObserveTable& o, const Subject& subject,
                                       const std::vector<Touch>& touches) const {
  std::vector<Vec3> values;
  if (o.quantity == Quantity::gap) {
    const std::vector<double> all = gaps(subject.wall, touches);
    for (const int e : subject.entities) values.push_back(as_vector(all[e]));
    return values;
  }
  const bool reaction = o.quantity == Quantity::reaction;
  std::map<int, Vec3> of_each;                        // it may touch several faces, at several places
  for (const Touch& t : touches)
    if (t.wall == subject.wall && (closed(model_, t) || (reaction && t.attracts)))
      of_each.emplace(t.particle, Vec3::Zero()).first->second += reaction ? t.force : as_vector(1);
  for (const auto& [e, value] : of_each) values.push_back(value);
  return values;
}

/// The smallest gap of every entity, to one wall or (−1) to anything; infinite where there is none.
std::vector<double> Observables::gaps(int wall, const std::vector<Touch>& touches) const {
  std::vector<double> all(entities(model_), infinity);
  for (const Touch& t : touches) {
    if (wall >= 0 && t.wall != wall) continue;
    all[t.particle] = std::min(all[t.particle], t.gap);
    if (t.other >= 0) all[t.other] = std::min(all[t.other], t.gap);
  }
  return all;
}

}  // namespace elamin
