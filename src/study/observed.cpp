#include "study/observed.hpp"

#include <memory>

namespace elamin {

std::vector<UserEvent> user_events(const Problem& problem, const Model& model) {
  std::vector<UserEvent> all;
  for (const EventTable& e : problem.events)
    for (std::size_t k = 0; k < problem.observe.size(); ++k) {
      if (problem.observe[k].name != e.observable) continue;
      const auto probe = std::make_shared<Probe>(problem, model, made_of(problem.observe, k));
      all.push_back({e.name, [probe](const State& state) { return (*probe)(state).back(); }, e.value, e.stop});
    }
  return all;
}

}  // namespace elamin
