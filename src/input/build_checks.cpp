#include "input/build_checks.hpp"

#include "dynamics/timestep.hpp"

#include "input/structures.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace elamin {

void check_distinct(const Problem& problem, const Model& model, Mistakes& mistakes) {
  // Sorted along a direction that no lattice is normal to, particles in one place are neighbours in the list.
  const Vec3 direction = Vec3(0.5180339887, 0.6823278038, 0.5158487229).normalized();
  const Vector along = model.start.position.transpose() * direction;
  std::vector<int> order(model.particles());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return std::pair(along[i], i) < std::pair(along[j], j); });
  const double widest = model.diameter.empty() ? 0 : *std::max_element(model.diameter.begin(), model.diameter.end());
  const double extent = model.start.position.size() ? model.start.position.cwiseAbs().maxCoeff() : 0;
  const double rounding = 8 * epsilon * extent;   // of `along`

  std::vector<int> structure(model.particles());
  for (int s = 0; s < static_cast<int>(model.structures.size()); ++s)
    std::fill_n(structure.begin() + model.structures[s].first, model.structures[s].count, s);
  std::set<std::pair<int, int>> told;
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const auto [i, j] = std::minmax(order[a], order[b]);
      if (along[order[b]] - along[order[a]] > 1e-9 * widest + rounding) break;
      const Vec3 apart = model.start.position.col(i) - model.start.position.col(j);
      if (apart.norm() > 1e-9 * std::min(model.diameter[i], model.diameter[j])) continue;
      const Structure &first = model.structures[structure[i]], &second = model.structures[structure[j]];
      const bool of_file = first.kind == "lammps" && second.kind == "lammps";
      const bool allowed = of_file && problem.study == StudyType::energy;
      if (!allowed && told.insert({structure[i], structure[j]}).second) {
        const Vec3 x = model.start.position.col(i);
        mistakes.add(
            place_of(problem, second),
            fmt::format(
                "{} is in the same place as {}, [{}, {}, {}]; particles must lie apart", called(model, j), called(model, i), x[0], x[1],
                x[2]));
      }
      if (told.size() > 20) return;
      break;   // on to the next of the list, so that a heap of many in one place takes no longer
    }
}

void check_plane(const Problem& problem, const Model& model, const State& state, const TablePlace& whose,
                 Mistakes& mistakes) {
  if (!model.plane_normal || state.particles() + state.bodies.size() == 0) return;
  const int c = *model.plane_normal;
  const auto at = [c](const State& s, std::size_t k) {
    const auto n = static_cast<std::size_t>(s.particles());
    return k < n ? s.position(c, static_cast<Eigen::Index>(k)) : s.bodies[k - n].position.hi[c];
  };
  const auto name = [&](std::size_t k) { return called(model, static_cast<int>(k)); };
  double extent = state.particles() > 0 ? state.position.cwiseAbs().maxCoeff() : 0;
  for (const Pose& pose : state.bodies) extent = std::max(extent, pose.position.hi.cwiseAbs().maxCoeff());
  const double level = at(model.start, 0);
  std::size_t worst = 0;
  for (std::size_t k = 0; k < state.particles() + state.bodies.size(); ++k)
    if (std::abs(at(state, k) - level) > std::abs(at(state, worst) - level)) worst = k;
  if (std::abs(at(state, worst) - level) > 1e-12 * extent)
    mistakes.add(whose, fmt::format("{} is not in the plane \"{}\" of {}: {} is {} instead of {}", name(worst), problem.plane,
                                    name(0), "xyz"[c], at(state, worst), level));
}

void check_timestep(const Problem& problem, const Model& model, Mistakes& mistakes) {
  const DynamicsTable& d = problem.dynamics;
  if (d.place.broken || !d.timestep || d.allow_unstable) return;
  Energy energy(model);
  State state = model.restart.value_or(model.start);
  energy.kinematics().prescribe(state, problem.path.start_lambda.value_or(1.0));
  if (const std::string why = unstable(timestep_limit(energy, state), *d.timestep); !why.empty())
    mistakes.add(d.place, "timestep", why + "; allow_unstable = true takes it nevertheless");
}

}  // namespace elamin
