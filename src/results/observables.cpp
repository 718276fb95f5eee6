#include "results/observables.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <limits>

namespace elamin {
namespace {

double component(const Vec3& v, Component c) {
  switch (c) {
    case Component::x: return v[0];
    case Component::y: return v[1];
    case Component::z: return v[2];
    case Component::norm: return v.stableNorm();
  }
  return 0;
}

}  // namespace

Observables::Observables(const Problem& problem, const Model& model)
    : problem_(problem), model_(model), held_(decltype(held_)::Constant(3, model.particles(), false)) {
  std::vector<Mistake> mistakes;
  for (const ObserveTable& o : problem.observe) {
    const auto it =
        std::find_if(model.groups.begin(), model.groups.end(), [&](const Group& g) { return g.name == o.group; });
    if (it == model.groups.end()) {
      std::string known;
      for (const Group& g : model.groups) known += (known.empty() ? "" : ", ") + g.name;
      mistakes.push_back({problem.file, o.place.line, o.place.column, "observe.group",
                          "there is no group \"" + o.group + "\"; there are " + known});
    } else if (it->particles.empty()) {
      mistakes.push_back({problem.file, o.place.line, o.place.column, "observe.group",
                          "the group \"" + o.group + "\" has no particle; at least one is needed"});
    }
    groups_.push_back(it == model.groups.end() ? nullptr : &*it);
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

std::vector<double> Observables::evaluate(const State& state, const Field& forces) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    const std::vector<int>& particles = groups_[k]->particles;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    ExactSum norms;
    ExactSum sums[3];
    for (const int i : particles) {
      const Vec3 v = of_particle(o.quantity, i, state, forces);
      const double value = component(v, o.component);
      least = std::min(least, value), most = std::max(most, value);
      norms.add(value);
      for (int c = 0; c < 3; ++c) sums[c].add(v[c]);
    }
    switch (o.reduce) {
      case Reduce::min: values.push_back(least); break;
      case Reduce::max: values.push_back(most); break;
      case Reduce::mean: values.push_back(norms.value() / static_cast<double>(particles.size())); break;
      case Reduce::sum:
        values.push_back(component({sums[0].value(), sums[1].value(), sums[2].value()}, o.component));
        break;
    }
  }
  return values;
}

Vec3 Observables::of_particle(Quantity quantity, int i, const State& state, const Field& forces) const {
  switch (quantity) {
    case Quantity::position: return state.position.col(i);
    case Quantity::displacement: {
      const ExactVector d = state.at(i) - model_.start.at(i);
      return d.hi + d.lo;
    }
    case Quantity::reaction: return (held_.col(i)).select(-forces.col(i), Vec3::Zero());
    case Quantity::velocity: return model_.velocity.cols() > 0 ? Vec3(model_.velocity.col(i)) : Vec3(Vec3::Zero());
  }
  return Vec3::Zero();
}

}  // namespace elamin
