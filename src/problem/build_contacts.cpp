#include "problem/build_contacts.hpp"

#include "dynamics/contact_damping.hpp"
#include "model/connect.hpp"
#include "problem/build_structures.hpp"
#include "problem/conditions.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

const Structure& structure_with(const Model& model, int particle) {
  return *std::find_if(model.structures.begin(), model.structures.end(),
                       [&](const Structure& s) { return particle < s.first + s.count; });
}

/// E_eff of two spheres: ((1 − ν₁²)/E₁ + (1 − ν₂²)/E₂)⁻¹, for like materials E/(2 (1 − ν²)).
/// Source: Guerra 2021, below equation (5).
double effective_modulus(const ContactTable& t) {
  if (t.effective_modulus) return *t.effective_modulus;
  const double E0 = t.youngs_modulus.front(), E1 = t.youngs_modulus.back();
  const double n0 = t.poissons_ratio.front(), n1 = t.poissons_ratio.back();
  const double c0 = (1 - n0) * (1 + n0), c1 = (1 - n1) * (1 + n1);
  return t.youngs_modulus.size() == 1 ? E0 / (2 * c0) : 1 / (c0 / E0 + c1 / E1);
}

/// E_eff at a rigid wall: E (equation (5)), or with a Poisson's ratio E/(2 (1 − ν²)), as LAMMPS has it.
double effective_modulus(const WallTable& t) {
  if (t.effective_modulus) return *t.effective_modulus;
  const double E = *t.youngs_modulus;
  if (!t.poissons_ratio) return E;
  const double nu = *t.poissons_ratio;
  return E / (2 * ((1 - nu) * (1 + nu)));
}

ContactDamping damping_of(const DampingKeys& keys) {
  ContactDamping d{keys.model, keys.coefficient.value_or(0), keys.friction_damping, keys.friction};
  if (d.model == ContactDamping::Model::tsuji) d.coefficient = tsuji_coefficient(*keys.restitution);
  return d;
}

class ContactBuilder {
 public:
  ContactBuilder(Groups& groups, Model& model, Mistakes& mistakes)
      : groups_(groups), model_(model), mistakes_(mistakes) {}

  bool add(const ContactTable& t) {
    PairContact c;
    c.between = t.between;
    if (t.place.broken || !both(t.place, t.between, c.particles)) return false;
    c.exclude_bonds = t.exclude_bonds;
    if (t.law == "lj") {
      c.law = PairContact::Law::lj;
      c.epsilon = *t.epsilon, c.sigma = *t.sigma, c.cutoff = *t.cutoff;
    } else {
      c.hard = t.hard, c.damping = damping_of(t.damping);
      c.effective_modulus = t.hard ? 0 : effective_modulus(t);
      if (!has_number(t.place, c.effective_modulus)) return false;
      if (c.hard || c.effective_modulus > 0)
        if (!round(t.place, "between", c.particles[0]) || !round(t.place, "between", c.particles[1])) return false;
    }
    model_.contacts.push_back(std::move(c));
    return true;
  }

  bool add(const WallTable& t, const Scaling& scaling) {
    const std::vector<int>* particles = t.place.broken ? nullptr : groups_.find(t.place, "group", t.group);
    if (!particles) return false;
    Wall w{t.name, t.group, *particles, with_unit_normal(t.region), t.inside, t.hard ? 0 : effective_modulus(t), t.curved,
           t.displacement, t.radius_change, scaling, t.hard, damping_of(t.damping)};
    if (!has_number(t.place, w.effective_modulus)) return false;
    if ((w.hard || w.effective_modulus > 0) && !round(t.place, "group", w.particles)) return false;
    model_.walls.push_back(std::move(w));
    return true;
  }

  bool add(const ConnectTable& t) {
    std::array<std::vector<int>, 2> particles;
    if (t.place.broken || !both(t.place, t.between, particles)) return false;
    Connection c;
    c.first = std::move(particles[0]), c.second = std::move(particles[1]);
    c.within = t.within, c.bonds_per_particle = t.bonds_per_particle.value_or(0);
    c.bond_stiffness = t.bond_stiffness, c.rest_length = t.rest_length.value_or(0);
    c.angle_stiffness = t.angle_stiffness.value_or(0);
    c.as_built = t.rest.as_built, c.rest = rest_angle(t.rest, pi);
    const int bonds = connect(model_, c);
    if (bonds > 0) return true;
    mistakes_.add(t.place, "within",
                  bonds < 0
                      ? fmt::format("makes more bonds than can be handled, {}; make it smaller", t.within)
                      : fmt::format("makes no bond: no particle of \"{}\" is within {} of one of \"{}\" that it is "
                                    "not bonded to already",
                                    t.between[1], t.within, t.between[0]));
    return false;
  }

 private:
  bool both(const TablePlace& place, const std::array<std::string, 2>& names,
            std::array<std::vector<int>, 2>& particles) {
    bool found = true;
    for (int side = 0; side < 2; ++side) {
      if (side == 1 && names[1] == names[0]) {
        particles[1] = particles[0];
        break;
      }
      const std::vector<int>* group = groups_.find(place, "between", names[side]);
      if (group) particles[side] = *group;
      found = found && group;
    }
    return found;
  }

  bool has_number(const TablePlace& place, double modulus) {
    if (std::isfinite(modulus)) return true;
    mistakes_.add(place, "its effective modulus is beyond what numbers can hold");
    return false;
  }

  /// Whether all of them are spheres; else that is told.
  bool round(const TablePlace& place, const char* key, const std::vector<int>& particles) {
    for (const int i : particles)
      if (!(model_.diameter[i] > 0)) {
        mistakes_.add(place, key,
                      fmt::format("particle {} of \"{}\" has no diameter, which contact needs", model_.id[i],
                                  structure_with(model_, i).name));
        return false;
      }
    return true;
  }

  Groups& groups_;
  Model& model_;
  Mistakes& mistakes_;
};

/// Where a run starts from at a load factor: prescribed coordinates are where they are then.
State start_at(const Model& model, double load_factor) {
  State state = model.restart ? *model.restart : model.start;
  state.load_factor = load_factor;
  for (const Support& s : model.supports)
    for (const int i : s.particles)
      for (int c = 0; c < 3; ++c)
        if (s.held[c])
          state.position(c, i) = model.start.position(c, i) + s.scaling.at(load_factor) * s.displacement[c];
  return state;
}

/// A gap is to something.
void check_gaps(const Problem& problem, Groups& groups, const Model& model, Mistakes& mistakes) {
  std::vector<bool> touches(model.particles(), false);
  for (const PairContact& c : model.contacts)
    for (const auto& side : c.particles)
      for (const int i : side) touches[i] = true;
  for (const Wall& w : model.walls)
    for (const int i : w.particles) touches[i] = true;
  const auto is_wall = [&](const std::string& name) {
    return std::any_of(model.walls.begin(), model.walls.end(), [&](const Wall& w) { return w.name == name; });
  };
  for (const ObserveTable& o : problem.observe) {
    if (o.place.broken || o.quantity != Quantity::gap || is_wall(o.group)) continue;
    const std::vector<int>* particles = groups.find(o.place, "group", o.group);
    if (particles && std::none_of(particles->begin(), particles->end(), [&](int i) { return touches[i]; }))
      mistakes.add(
          o.place, "quantity",
          fmt::format("there is no [[contact]] and no [[wall]] for \"{}\"; a gap is to something that may touch",
                      o.group));
  }
}

}  // namespace

Region with_unit_normal(Region region) {
  if (region.shape == Shape::plane) region.normal = (region.normal / region.normal.cwiseAbs().maxCoeff()).normalized();
  return region;
}

bool add_connections(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  ContactBuilder builder(groups, model, mistakes);
  bool whole = true;
  for (const ConnectTable& t : problem.connections) whole = builder.add(t) && whole;
  return whole;
}

bool add_contacts(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  ContactBuilder builder(groups, model, mistakes);
  bool whole = true;
  for (const ContactTable& t : problem.contacts) whole = builder.add(t) && whole;
  for (std::size_t k = 0; k < problem.walls.size(); ++k)
    whole = builder.add(problem.walls[k], scaling_of(problem, condition_of("wall", problem.walls, k))) && whole;
  if (whole) check_gaps(problem, groups, model, mistakes);
  return whole;
}

void check_sides(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (problem.study == StudyType::energy) return;
  // A path starts at its own load factor. An equilibrium at 1 may be reached from what was built at 0.
  std::vector<double> factors{1};
  if (problem.study == StudyType::path)
    factors = {(model.restart ? *model.restart : model.start).load_factor};
  else if (!model.restart)
    factors = {0, 1};
  std::vector<State> states;
  for (const double factor : factors) states.push_back(start_at(model, factor));
  for (const Wall& w : model.walls) {
    if (w.region.any_open() || (w.effective_modulus == 0 && !w.hard)) continue;
    const auto wrong = [&](int i) {
      return std::all_of(states.begin(), states.end(), [&](const State& state) {
        const double part = w.scaling.at(state.load_factor);
        return w.region.moved(part * w.displacement, part * w.radius_change).contains(state.at(i)) != w.inside;
      });
    };
    const auto first = std::find_if(w.particles.begin(), w.particles.end(), wrong);
    if (first == w.particles.end()) continue;
    const auto more = std::count_if(first + 1, w.particles.end(), wrong);
    const auto table = std::find_if(problem.walls.begin(), problem.walls.end(),
                                    [&](const WallTable& t) { return t.name == w.name; });
    const Vec3 x = states[0].position.col(*first);
    mistakes.add(table->place, "side",
                 fmt::format("particle {} of \"{}\" is {} of it, at [{}, {}, {}]{}; it must be {}", model.id[*first],
                             structure_with(model, *first).name, w.inside ? "outside" : "inside", x[0], x[1], x[2],
                             more > 0 ? fmt::format(", and {} more are", more) : "", w.inside ? "inside" : "outside"));
  }
}

}  // namespace elamin
