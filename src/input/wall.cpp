#include "input/wall.hpp"

#include "core/find.hpp"
#include "energy/kinematics.hpp"
#include "input/conditions.hpp"
#include "input/parts.hpp"
#include "input/stages.hpp"
#include "laws/frustum.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace elamin {

namespace {

constexpr Word<bool> side_words[]{{"inside", true}, {"outside", false}};
constexpr Word<bool> effective_radius_words[]{{"particle", false}, {"curved", true}};
constexpr Word<bool> wall_formulation_words[]{{"potential", false}, {"lammps", true}};

}  // namespace

void describe(Keys& keys, WallTable& t) {
  keys.about("A rigid wall, the surface of a region.");
  keys.name("name", t.name, "its name, for observables too");
  keys.may("group", t.group, "what feels it");
  keys.word("side", t.inside, side_words, "where that is");
  keys.may("youngs_modulus", t.youngs_modulus, "E; alone it is E_eff [force/length²]", range::positive);
  keys.may("poissons_ratio", t.poissons_ratio, "ν: E_eff = E/(2 (1 − ν²))", range::poissons_ratio);
  keys.may("effective_modulus", t.effective_modulus, "E_eff itself [force/length²]", range::not_negative);
  keys.word("effective_radius", t.curved, effective_radius_words, "the particle's own, or with the wall's curvature, as LAMMPS does");
  keys.may("displacement", t.displacement, "at load factor 1 [length]");
  keys.may("radius_change", t.radius_change, "at load factor 1 [length]");
  keys.may("hard", t.hard, "impenetrable instead of elastic");
  describe_damping(keys, t.damping);
  keys.may("k_n", t.k_n, "of bodies: stiffness of overlaps [force/length]", range::not_negative);
  keys.may("k_na", t.k_na, "of bodies: of attraction within the cutoff [force/length]", range::not_negative);
  keys.may("cutoff", t.cutoff, "of bodies: of the separation [length]", range::not_negative);
  keys.may("c_n", t.c_n, "of bodies: damping along the normal [force·time/length]", range::not_negative);
  keys.may("c_t", t.c_t, "of bodies: damping across it [force·time/length]; by default c_n/2", range::not_negative);
  keys.word("formulation", t.lammps, wall_formulation_words, "of bodies: with an energy, or LAMMPS's rules");
  keys.may("from_stage", t.from_stage, "the stage it is in force from; by default from the start");
  describe_region(keys, t.region);
}

namespace {

/// The radius must stay one at every load factor in use.
void check_radius(const Problem& problem, WallTable& w, const Scaling& scaling, Mistakes& mistakes) {
  if (w.radius_change == 0) return;
  const Region& r = w.region;
  if (r.shape == Shape::plane || r.shape == Shape::block)
    return mistakes.add(w.place, "radius_change", fmt::format("a {} has no radius; leave it out", name_of(r.shape)));
  const bool cone = r.shape == Shape::cone;
  for (const double lambda : load_factors(problem)) {
    const double change = scaling.at(lambda) * w.radius_change;
    const double smallest = cone ? std::min(r.radius_lo, r.radius_hi) + change : r.radius + change;
    const double largest = cone ? std::max(r.radius_lo, r.radius_hi) + change : smallest;
    if (smallest >= 0 && largest > 0) continue;
    return mistakes.add(w.place, "radius_change",
                        fmt::format("makes a radius {} at load factor {}; a radius is {}", smallest, lambda,
                                    cone ? "not negative, and positive at one end at least" : "positive"));
  }
}

void check_of_particles(const Problem& problem, WallTable& w, const Scaling& scaling, Mistakes& mistakes) {
  check_region(w.place, w.region, false, mistakes);
  check_radius(problem, w, scaling, mistakes);
  check_damping(w.place, w.damping, mistakes);
  if (w.hard) return check_hard(problem, w.place, mistakes);
  if (!has_effective_modulus(w.place, mistakes) && !w.place.written("youngs_modulus") && !w.k_n)
    mistakes.add(w.place, "youngs_modulus", "is missing; it must be a positive number, or give effective_modulus, or k_n for bodies");
}

void check_of_bodies(const Problem& problem, WallTable& w, Mistakes& mistakes) {
  if (!w.k_n) {
    const std::pair<const char*, bool> said[]{{"k_na", w.k_na > 0}, {"cutoff", w.cutoff > 0}, {"c_n", w.c_n > 0}, {"c_t", w.c_t.has_value()},
                                              {"formulation", w.lammps}};
    for (const auto& [key, there] : said)
      if (there) mistakes.add(w.place, key, "is of bodies, and so needs k_n");
    return;
  }
  if (w.k_na > 0 && !(w.cutoff > 0))
    mistakes.add(w.place, "cutoff", "is missing; it must be a positive number, within which k_na attracts");
  if (!w.lammps) return;
  check_potential(problem, w.place, "\"lammps\" has no potential: its forces have no energy; take formulation = \"potential\"", mistakes);
  if (w.k_na > 0) mistakes.add(w.place, "k_na", "does not go with formulation = \"lammps\", whose walls do not attract; leave it out");
  const Region& r = w.region;
  const bool across = r.shape == Shape::plane && (r.normal.array() != 0).count() == 1;
  if (!across && !(r.shape == Shape::block && w.inside))
    mistakes.add(w.place, "shape", "with formulation = \"lammps\" must be a plane across an axis, or a block, inside");
}

Scaling scaling_of_wall(const Problem& problem, std::size_t k) { return scaling_of(problem, condition_of("wall", problem.walls, k)); }

}  // namespace

void check_walls(Problem& problem, Names& names, Mistakes& mistakes) {
  for (WallTable& w : problem.walls) names.add_wall(w.place, w.name);
  for (std::size_t k = 0; k < problem.walls.size(); ++k) {
    WallTable& w = problem.walls[k];
    const bool whole = !w.place.broken;
    names.refer(w.place, "group", w.group);
    if (whole) check_of_particles(problem, w, scaling_of_wall(problem, k), mistakes);
    if (!w.place.broken) check_of_bodies(problem, w, mistakes);
  }
}

namespace {

/// E_eff at a rigid wall: E (Guerra 2021, equation (5)), or with a Poisson's ratio E/(2 (1 − ν²)), as LAMMPS has it.
double effective_modulus(const WallTable& t) {
  if (t.effective_modulus) return *t.effective_modulus;
  const double E = *t.youngs_modulus;
  if (!t.poissons_ratio) return E;
  const double nu = *t.poissons_ratio;
  return E / (2 * ((1 - nu) * (1 + nu)));
}

/// Whether the group of a wall has what the wall's numbers are of, and the wall can be one of bodies.
bool can_have(const WallTable& t, const Members& members, Mistakes& mistakes) {
  bool good = true;
  const auto wrong = [&](const char* key, const std::string& what) { mistakes.add(t.place, key, what), good = false; };
  const bool elastic = t.effective_modulus || t.youngs_modulus;
  if (!members.particles.empty() && !elastic && !t.hard)
    wrong("youngs_modulus", fmt::format("is missing; \"{}\" has particles: it must be a positive number, or give effective_modulus", t.group));
  if (members.bodies.empty()) {
    if (t.k_n) wrong("k_n", fmt::format("is of bodies, and \"{}\" has none; leave it out", t.group));
    return good;
  }
  if (t.hard) wrong("hard", fmt::format("\"{}\" has bodies, which feel no hard walls; give k_n", t.group));
  else if (!t.k_n) wrong("k_n", fmt::format("is missing; \"{}\" has bodies: it must be a number that is not negative", t.group));
  if (t.radius_change != 0) wrong("radius_change", fmt::format("\"{}\" has bodies; for them a wall keeps its radius", t.group));
  if (!t.lammps && t.region.shape != Shape::plane && !t.inside)
    wrong("side", fmt::format("\"{}\" has bodies, which feel planes from either side and other walls from inside", t.group));
  return good;
}

bool add_wall(const WallTable& t, const Scaling& scaling, Groups& groups, Model& model, Mistakes& mistakes) {
  const Members* members = groups.find(t.place, "group", t.group);
  if (!members || !can_have(t, *members, mistakes)) return false;
  const bool elastic = !t.hard && !members->particles.empty();
  Wall w{t.name, t.group, members->particles, with_unit_normal(t.region), t.inside, elastic ? effective_modulus(t) : 0, t.curved,
         t.displacement, t.radius_change, scaling, t.hard, damping_of(t.damping), members->bodies};
  w.kernel = {t.k_n.value_or(0), t.k_na, t.cutoff, RoundedKernel::Form::coded};
  w.body_damping.normal = t.c_n, w.body_damping.tangential = t.c_t.value_or(t.c_n / 2);
  w.lammps = t.lammps;
  if (!is_finite_modulus(t.place, w.effective_modulus, mistakes)) return false;
  if ((w.hard || w.effective_modulus > 0) && !are_spheres(t.place, "group", w.particles, model, mistakes)) return false;
  model.walls.push_back(std::move(w));
  return true;
}

}  // namespace

bool add_walls(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  for (std::size_t k = 0; k < problem.walls.size(); ++k)
    whole = add_wall(problem.walls[k], scaling_of_wall(problem, k), groups, model, mistakes) && whole;
  return whole;
}

namespace {

/// Particles, and bodies, of a wall that are on its wrong side in each of these states, a sentence each.
std::vector<std::string> on_wrong_side(const Model& model, const Wall& w, const std::vector<State>& states) {
  std::vector<std::string> sentences;
  if (w.region.any_open()) return sentences;
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
    const Vec3 x = at(states[0], *first).hi;
    sentences.push_back(fmt::format("{} is {} of it, at [{}, {}, {}]{}; it must be {}", name(*first), w.inside ? "outside" : "inside", x[0], x[1], x[2],
                                    more > 0 ? fmt::format(", and {} more are", more) : "", w.inside ? "inside" : "outside"));
  };
  if (w.effective_modulus > 0 || w.hard)
    tell(w.particles, [](const State& state, int i) { return state.at(i); }, [&](int i) { return called(model, i); });
  if (w.kernel.normal > 0 && !w.lammps)
    tell(w.bodies, [](const State& state, int b) { return state.bodies[b].position; },
         [&](int b) { return called(model, model.particles() + b); });
  return sentences;
}

}  // namespace

void check_sides(const Problem& problem, const Model& model, Mistakes& mistakes) {
  if (problem.study == StudyType::energy) return;
  const bool staged = !problem.stages.empty();
  if (staged && model.restart) return;            // which stage the state is of is known when the path goes on
  // A path starts at its own load factor. An equilibrium at 1 may be reached from what was built at 0.
  std::vector<double> factors{1};
  if (problem.follows_path())
    factors = {(model.restart ? *model.restart : model.start).load_factor};
  else if (!model.restart)
    factors = {0, 1};
  const Kinematics kinematics(model);
  std::vector<State> states(factors.size(), model.restart ? *model.restart : model.start);
  for (std::size_t k = 0; k < factors.size(); ++k) kinematics.prescribe(states[k], factors[k]);
  std::optional<Model> first;
  if (staged) {
    std::string unclear;
    Model all = model;
    first = model_in(problem, Stages(problem).enter(unclear), all, model.start);
  }
  for (const Wall& w : (first ? *first : model).walls) {
    const WallTable* table = find_named(problem.walls, w.name);
    for (const std::string& sentence : on_wrong_side(model, w, states)) mistakes.add(table->place, "side", sentence);
  }
}

std::string on_wrong_side(const Model& in_stage, State start, double load_factor) {
  Kinematics(in_stage).prescribe(start, load_factor);
  for (const Wall& w : in_stage.walls)
    for (const std::string& sentence : on_wrong_side(in_stage, w, {start})) return fmt::format("wall.{}.side: {}", w.name, sentence);
  return "";
}

}  // namespace elamin
