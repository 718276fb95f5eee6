#include "input/parts.hpp"

#include "dynamics/timestep.hpp"
#include "energy/kinematics.hpp"
#include "model/entities.hpp"
#include "model/rigid_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

  const std::vector<int> structure = structure_of(model);
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
        mistakes.add(place_of(problem, second), fmt::format("{} is in the same place as {}, [{}, {}, {}]; particles must lie apart",
                                                            called(model, j), called(model, i), x[0], x[1], x[2]));
      }
      if (told.size() > 20) return;
      break;   // on to the next of the list, so that a heap of many in one place takes no longer
    }
}

void check_plane(const Problem& problem, const Model& model, const State& state, const TablePlace& whose, Mistakes& mistakes) {
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

namespace {

/// Those of a group.
template <class Each> void for_entities(const Model& model, const std::vector<int>& particles, const std::vector<int>& bodies, const Each& each) {
  for (const int i : particles) each(i);
  for (const int b : bodies) each(model.particles() + b);
}

bool acts(const PairContact& c) { return c.hard || c.effective_modulus > 0 || c.epsilon > 0; }
bool acts(const RoundedPair& r) { return r.kernel.normal > 0 || r.kernel.attraction > 0; }

/// The glued parts, and which of them may touch each other.
class HeldParts {
 public:
  explicit HeldParts(const Model& model) : part_(connected_parts(model)) {
    int count = 0;
    for (const int p : part_) count = std::max(count, p + 1);
    root_.resize(count);
    std::iota(root_.begin(), root_.end(), 0);
    held_.resize(count), touched_.resize(count), size_.resize(count), kept_.resize(count);
    for (const int p : part_) ++size_[p];
    for (const Support& s : model.supports) for_entities(model, s.particles, s.bodies, [&](int i) { held_[part_[i]] = true; });
    for (const PairContact& c : model.contacts)
      if (acts(c)) touch(c.particles);
    for (const RoundedPair& r : model.rounded) {
      std::array<std::vector<int>, 2> sides;
      for (int side = 0; side < 2; ++side)
        for_entities(model, r.particles[side], r.bodies[side], [&](int i) { sides[side].push_back(i); });
      if (acts(r)) touch(sides);
    }
    std::vector<bool> walled(count);
    for (const Wall& w : model.walls)
      if (w.hard || w.effective_modulus > 0)
        for (const int i : w.particles) touched_[part_[i]] = walled[part_[i]] = true;
    for (const Wall& w : model.walls)
      if (w.kernel.normal > 0 || w.kernel.attraction > 0)
        for (const int b : w.bodies) {
          const int part = part_[model.particles() + b];
          touched_[part] = walled[part] = true;
        }
    for (const OwnLaw& law : model.own)
      for (const std::vector<int>& element : law.elements)
        if (law.anchored)
          for (const int i : element) touched_[part_[i]] = walled[part_[i]] = true;
    for (int p = 0; p < count; ++p)
      if (held_[p] || walled[p]) kept_[find(p)] = true;
  }

  bool held(int entity) const { return held_[part_[entity]]; }          // a support holds it
  bool touched(int entity) const { return touched_[part_[entity]]; }    // a wall, another part or a law of a program's own may hold it
  bool alone(int entity) const { return size_[part_[entity]] == 1; }
  /// All that may touch each other, by number, and whether a support or a wall may hold it.
  int cluster(int entity) const { return find(part_[entity]); }
  bool kept(int entity) const { return kept_[cluster(entity)]; }

 private:
  /// Any entity of one side may touch any of the other, so that all of them belong together.
  void touch(const std::array<std::vector<int>, 2>& sides) {
    const int first = part_[sides[0].front()];
    bool others = false;
    for (const auto& side : sides)
      for (const int i : side) others = others || part_[i] != first;
    if (!others) return;
    for (const auto& side : sides)
      for (const int i : side) {
        touched_[part_[i]] = true;
        root_[find(part_[i])] = find(first);
      }
  }
  int find(int p) const {
    while (root_[p] != p) p = root_[p];
    return p;
  }

  std::vector<int> part_, root_, size_;
  std::vector<bool> held_, touched_, kept_;
};

/// Of every cluster: whether dead loads and weights leave a force on it, or loads on bodies a torque, which only a support or a wall
/// could bear. (Forces that turn a cluster as a whole turn with it until they do no more.)
std::vector<bool> driven(const Model& model, const HeldParts& parts) {
  struct Forces { std::array<Vec3, 2> sum{Vec3::Zero(), Vec3::Zero()}; double size = 0; };   // scaled, constant
  std::vector<Forces> forces(entities(model)), torques(entities(model));
  const auto add_to = [&](std::vector<Forces>& to, int i, const Vec3& force, const Scaling& scaling) {
    Forces& f = to[parts.cluster(i)];
    f.sum[0] += scaling.rate * force, f.sum[1] += scaling.fixed * force, f.size += force.cwiseAbs().maxCoeff();
  };
  const auto add = [&](int i, const Vec3& force, const Scaling& scaling) { add_to(forces, i, force, scaling); };
  for (const Load& l : model.loads) {
    for (const int b : l.bodies) add_to(torques, model.particles() + b, l.torque, l.scaling);
    for (std::size_t k = 0; k < l.particles.size(); ++k) add(l.particles[k], l.on(k), l.scaling);
    for (const int b : l.bodies) add(model.particles() + b, l.force, l.scaling);
  }
  for (const Gravity& g : model.gravity) {
    for (const int i : g.particles) add(i, model.mass(i) * g.acceleration, g.scaling);
    for (const int b : g.bodies) add(model.particles() + b, model.bodies[b].mass * g.acceleration, g.scaling);
  }
  std::vector<bool> left(entities(model));
  for (const auto* acting : {&forces, &torques})
    for (std::size_t k = 0; k < acting->size(); ++k)
      for (const Vec3& sum : (*acting)[k].sum) left[k] = left[k] || sum.cwiseAbs().maxCoeff() > 1e-9 * (*acting)[k].size;
  return left;
}

}  // namespace

void check_held(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (problem.study == StudyType::energy || problem.study == StudyType::modes) return;   // a free motion is a mode
  if (problem.in_time()) return;           // … or a motion
  const HeldParts parts(model);
  const std::vector<bool> force = driven(model, parts);
  // What floats, and nothing pulls on it, has an equilibrium for a file that asks for one; else a support has been forgotten.
  const bool asked = problem.study_place.keys.count("type") > 0 && problem.stages.empty();
  const std::vector<int> structure = structure_of(model);
  std::vector<bool> told(model.structures.size());
  const auto tell = [&](int i, const std::string& what) {
    if (!told[structure[i]]) mistakes.add(place_of(problem, model.structures[structure[i]]), what);
    told[structure[i]] = true;
  };
  for (int i = 0; i < entities(model); ++i) {
    if (parts.held(i)) continue;
    const Structure& s = model.structures[structure[i]];
    if (parts.touched(i)) {
      if (!parts.kept(i) && force[parts.cluster(i)])
        tell(i, fmt::format("{} and all that it may touch are held by no [[support]] and no [[wall]], and the "
                            "forces on them do not cancel", called(model, i)));
    } else if (parts.alone(i)) {
      if (force[parts.cluster(i)])
        tell(i, fmt::format("a force acts on {}, which nothing holds; an equilibrium needs a [[support]], a "
                            "[[wall]] or a [[contact]]", called(model, i)));
    } else if (!asked || force[parts.cluster(i)]) {
      const std::string of_file =
          fmt::format("{} is connected to {} that a support holds", called(model, i), model.bodies.empty() ? "no particle" : "nothing");
      tell(i, (s.kind == "lammps" ? of_file : "none of its particles is held by a support") + "; an equilibrium needs a [[support]]");
    }
  }
  // What is held may still move as a whole. A translation is never an equilibrium's business; a rotation is if
  // something acts on it, as a weight on a pendulum does, or if the state comes from a file, as a buckled column's
  // does. What may touch something is held by that.
  const bool loaded = !problem.loads.empty() || !problem.gravity.empty() || !problem.path.start.empty();
  std::vector<std::string> names(model.structures.size());
  for (const RigidMotion& m : free_rigid_motions(model, model.start)) {
    if (m.particle >= model.particles() || !parts.held(m.particle) || parts.touched(m.particle)) continue;
    const int s = structure[m.particle];
    const bool allowed = !m.translation && (loaded || model.structures[s].kind == "lammps");
    if (!allowed && names[s].size() < 500) names[s] += (names[s].empty() ? "" : ", ") + m.name;
  }
  for (std::size_t s = 0; s < names.size(); ++s)
    if (!names[s].empty())
      mistakes.add(place_of(problem, model.structures[s]), "free to move as a whole: " + names[s] + "; hold it with a [[support]]");
}

void check_modes(const Problem& problem, const Model& model, Mistakes& mistakes) {
  const bool modes = problem.study == StudyType::modes;
  if (!modes && !(problem.follows_path() && problem.stages.empty())) return;     // what stages let go is free
  const int free = Kinematics(model).dofs();
  const auto limit = [&](const TablePlace& place, const char* key, int count, const char* what) {
    if (free < count) mistakes.add(place, key, fmt::format("asks for {} {}; only {} coordinates are free", count, what, free));
  };
  if (modes) limit(problem.modes.place, "count", problem.modes.count, "modes");
  else limit(problem.path.place, "eigenvalues", problem.path.eigenvalues, "eigenvalues");
}

}  // namespace elamin
