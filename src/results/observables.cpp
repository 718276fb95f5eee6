#include "results/observables.hpp"

#include "core/error.hpp"

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
  constexpr double rounding = 1e-12;                  // of the diameter
  return t.bears || t.gap < -rounding * model.diameter[t.particle];
}

bool scalar(Quantity q) { return q == Quantity::gap || q == Quantity::contacts; }
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

}  // namespace

Observables::Observables(const Problem& problem, const Model& model)
    : problem_(problem), model_(model), held_(decltype(held_)::Constant(3, model.particles(), false)) {
  std::vector<Mistake> mistakes;
  const auto wrong = [&](const ObserveTable& o, const char* key, const std::string& what) {
    mistakes.push_back({problem.file, o.place.line, o.place.column, key, what});
  };
  for (const ObserveTable& o : problem.observe) {
    Subject subject;
    for (const Group& g : model.groups)
      if (g.name == o.group) subject.particles = &g.particles;
    for (std::size_t w = 0; w < model.walls.size(); ++w)
      if (model.walls[w].name == o.group && !subject.particles)
        subject = {&model.walls[w].particles, static_cast<int>(w)};
    if (!subject.particles) {
      std::string known;
      for (const Group& g : model.groups) known += (known.empty() ? "" : ", ") + g.name;
      for (const Wall& w : model.walls) known += ", " + w.name;
      wrong(o, "observe.group", "there is no group \"" + o.group + "\"; there are " + known);
    } else if (subject.particles->empty() && subject.wall < 0) {
      wrong(o, "observe.group", "the group \"" + o.group + "\" has no particle; at least one is needed");
    } else if (subject.wall >= 0 && o.quantity != Quantity::reaction && !scalar(o.quantity)) {
      wrong(o, "observe.quantity", "\"" + o.group + "\" is a wall; it has a reaction, gap and contacts only");
    }
    subjects_.push_back(subject);
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  for (const Support& s : model.supports)
    for (const int i : s.particles)
      for (int c = 0; c < 3; ++c) held_(c, i) = held_(c, i) || s.held[c];
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
    const std::vector<int>& particles = *subjects_[k].particles;
    if (o.reduce == Reduce::min ? std::none_of(particles.begin(), particles.end(), known)
                                : !std::all_of(particles.begin(), particles.end(), known))
      return false;
  }
  return true;
}

std::vector<double> Observables::evaluate(const State& state, const Field& forces, const std::vector<Touch>& touches,
                                          const Field* velocity) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < subjects_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    const Subject& subject = subjects_[k];
    const std::vector<Vec3> of_particles =
        subject.wall >= 0 ? of_wall(o, subject, touches) : of_group(o, subject, state, forces, touches, velocity ? *velocity : model_.velocity);
    values.push_back(reduced(of_particles, scalar(o.quantity) ? Component::x : o.component, o.reduce));
  }
  return values;
}

std::vector<Vec3> Observables::of_group(const ObserveTable& o, const Subject& subject, const State& state,
                                        const Field& forces, const std::vector<Touch>& touches,
                                        const Field& velocity) const {
  std::vector<double> scalars;                        // of all particles
  if (o.quantity == Quantity::gap) scalars = gaps(-1, touches);
  if (o.quantity == Quantity::contacts) {
    scalars.resize(model_.particles());
    for (const Touch& t : touches)
      if (closed(model_, t)) {
        ++scalars[t.particle];
        if (t.other >= 0) ++scalars[t.other];
      }
  }
  std::vector<Vec3> values;
  for (const int i : *subject.particles) switch (o.quantity) {
      case Quantity::position: values.push_back(state.position.col(i)); break;
      case Quantity::displacement: {
        const ExactVector d = state.at(i) - model_.start.at(i);
        values.push_back(d.hi + d.lo);
        break;
      }
      case Quantity::reaction: values.push_back(held_.col(i).select(-forces.col(i), Vec3::Zero())); break;
      case Quantity::velocity:
        values.push_back(velocity.cols() > 0 ? Vec3(velocity.col(i)) : Vec3(Vec3::Zero()));
        break;
      case Quantity::gap:
      case Quantity::contacts: values.push_back(as_vector(scalars[i])); break;
    }
  return values;
}

std::vector<Vec3> Observables::of_wall(const ObserveTable& o, const Subject& subject,
                                       const std::vector<Touch>& touches) const {
  std::vector<Vec3> values;
  if (o.quantity == Quantity::gap) {
    const std::vector<double> all = gaps(subject.wall, touches);
    for (const int i : *subject.particles) values.push_back(as_vector(all[i]));
    return values;
  }
  std::map<int, Vec3> of_particle;                    // a particle may touch several faces
  for (const Touch& t : touches)
    if (t.wall == subject.wall && closed(model_, t))
      of_particle.emplace(t.particle, Vec3::Zero()).first->second +=
          o.quantity == Quantity::reaction ? t.force : as_vector(1);
  for (const auto& [i, value] : of_particle) values.push_back(value);
  return values;
}

/// The smallest gap of every particle, to one wall or (−1) to anything; infinite where there is none.
std::vector<double> Observables::gaps(int wall, const std::vector<Touch>& touches) const {
  std::vector<double> all(model_.particles(), infinity);
  for (const Touch& t : touches) {
    if (wall >= 0 && t.wall != wall) continue;
    all[t.particle] = std::min(all[t.particle], t.gap);
    if (t.other >= 0) all[t.other] = std::min(all[t.other], t.gap);
  }
  return all;
}

}  // namespace elamin
