#include "study/observed.hpp"

#include "model/entities.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace elamin {

namespace {

// One observable at any state.
class Probe {
 public:
  Probe(const Problem& problem, const Model& model, const ObserveTable& observable)
      : problem_(only(problem, observable)), energy_(model), observables_(problem_, model) {}

  double operator()(const State& state) {
    return observables_.evaluate(state, energy_.forces(state), observed_touches(energy_, state, observables_))[0];
  }

 private:
  static Problem only(const Problem& problem, const ObserveTable& observable) {
    Problem one;
    one.file = problem.file, one.observe = {observable};
    return one;
  }
  Problem problem_;                    // with this observable alone
  Energy energy_;
  Observables observables_;
};

}  // namespace

std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables) {
  constexpr double at_touch = 1e-9;                             // of the largest size: what an event has located
  const double largest = largest_size(energy.model());
  std::vector<Touch> touches = energy.touches(state, at_touch * largest);
  const double extent = sides_of(state).maxCoeff();
  for (double reach = largest / 4; !observables.sufficient(touches); reach *= 4) {
    const bool all = !(reach > 0 && reach < extent);
    touches = energy.touches(state, all ? std::numeric_limits<double>::infinity() : reach);
    if (all) break;
  }
  return touches;
}

std::vector<Watch> watches(const Problem& problem, const Model& model) {
  std::vector<Watch> all;
  for (const EventTable& e : problem.events)
    for (const ObserveTable& o : problem.observe) {
      if (o.name != e.observable) continue;
      const auto probe = std::make_shared<Probe>(problem, model, o);
      all.push_back({e.name, [probe](const State& state) { return (*probe)(state); }, e.value, e.stop});
    }
  return all;
}

}  // namespace elamin
