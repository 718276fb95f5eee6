// On which side of their walls particles and bodies start.
#include "input/interactions.hpp"

#include "energy/kinematics.hpp"
#include "laws/frustum.hpp"
#include "input/bodies.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {
void check_sides(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (problem.study == StudyType::energy) return;
  // A path starts at its own load factor. An equilibrium at 1 may be reached from what was built at 0.
  std::vector<double> factors{1};
  if (problem.study == StudyType::path)
    factors = {(model.restart ? *model.restart : model.start).load_factor};
  else if (!model.restart)
    factors = {0, 1};
  const Kinematics kinematics(model);
  std::vector<State> states(factors.size(), model.restart ? *model.restart : model.start);
  for (std::size_t k = 0; k < factors.size(); ++k) kinematics.prescribe(states[k], factors[k]);
  for (const Wall& w : model.walls) {
    if (w.region.any_open()) continue;
    const auto tell = [&](const std::vector<int>& members, const auto& at, const auto& name) {
      const auto wrong = [&](int i) {
        return std::all_of(states.begin(), states.end(), [&](const State& state) {
          const double part = w.scaling.at(state.load_factor);
          return !on_side(w.region.moved(part * w.displacement, part * w.radius_change), w.inside, at(state, i));
        });
      };
      const auto first = std::find_if(members.begin(), members.end(), wrong);
      if (first == members.end()) return;
      const auto more = std::count_if(first + 1, members.end(), wrong);
      const auto table = std::find_if(problem.walls.begin(), problem.walls.end(), [&](const WallTable& t) { return t.name == w.name; });
      const Vec3 x = at(states[0], *first).hi;
      mistakes.add(table->place, "side",
                   fmt::format("{} is {} of it, at [{}, {}, {}]{}; it must be {}", name(*first), w.inside ? "outside" : "inside", x[0],
                               x[1], x[2], more > 0 ? fmt::format(", and {} more are", more) : "", w.inside ? "inside" : "outside"));
    };
    if (w.effective_modulus > 0 || w.hard)
      tell(w.particles, [](const State& state, int i) { return state.at(i); },
           [&](int i) { return called(model, i); });
    if (w.kernel.normal > 0 && !w.lammps)
      tell(w.bodies, [](const State& state, int b) { return state.bodies[b].position; },
           [&](int b) { return called(model, model.particles() + b); });
  }
}

}  // namespace elamin
