#include "input/interactions.hpp"

#include "dynamics/contact_damping.hpp"
#include "model/connect.hpp"
#include "model/entities.hpp"
#include "input/check_parts.hpp"
#include "input/conditions.hpp"
#include "input/listed.hpp"
#include "input/staged_structure.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

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
    std::array<Members, 2> members;
    if (t.place.broken || !both(t.place, t.between, members)) return false;
    if (t.law == "rounded") return add_rounded(t, members);
    PairContact c;
    c.between = t.between;
    if (!take_particles(t, members, c.particles)) return false;
    c.exclude_bonds = t.exclude_bonds;
    if (t.law == "lj") {
      c.law = PairContact::Law::lj;
      c.epsilon = *t.epsilon, c.sigma = *t.sigma, c.cutoff = *t.cutoff;
      c.cutoff_style = t.cutoff_style, c.inner_cutoff = t.inner_cutoff.value_or(0);
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
    const Members* members = t.place.broken ? nullptr : groups_.find(t.place, "group", t.group);
    if (!members || !can_have(t, *members)) return false;
    const bool elastic = !t.hard && !members->particles.empty();
    Wall w{t.name, t.group, members->particles, with_unit_normal(t.region), t.inside, elastic ? effective_modulus(t) : 0, t.curved,
           t.displacement, t.radius_change, scaling, t.hard, damping_of(t.damping), members->bodies};
    w.kernel = {t.k_n.value_or(0), t.k_na, t.cutoff, RoundedKernel::Form::coded};
    w.body_damping.normal = t.c_n, w.body_damping.tangential = t.c_t.value_or(t.c_n / 2);
    w.lammps = t.lammps;
    if (!has_number(t.place, w.effective_modulus)) return false;
    if ((w.hard || w.effective_modulus > 0) && !round(t.place, "group", w.particles)) return false;
    model_.walls.push_back(std::move(w));
    return true;
  }

  bool add(const ConnectTable& t) {
    std::array<Members, 2> members;
    std::array<std::vector<int>, 2> particles;
    if (t.place.broken || !both(t.place, t.between, members) || !take_particles(t, members, particles)) return false;
    Connection c = connection_of(t);
    c.first = std::move(particles[0]), c.second = std::move(particles[1]);
    const int bonds = connect(model_, c);
    if (bonds > 0) return true;
    if (!t.within) {
      mistakes_.add(t.place, "rule", bonds < 0 ? "has more pairs to look at than can be; give within" : "makes no bond: there is none to bond");
      return false;
    }
    mistakes_.add(t.place, "within",
                  bonds < 0
                      ? fmt::format("makes more bonds than can be handled, {}; make it smaller", *t.within)
                      : fmt::format("makes no bond: no particle of \"{}\" is within {} of one of \"{}\" that it is "
                                    "not bonded to already",
                                    t.between[1], *t.within, t.between[0]));
    return false;
  }

  /// `now`: else it is only looked whether it can be made.
  bool add(const BondsTable& t, bool now) {
    if (t.place.broken) return false;
    if (t.rule) return !now || add(by_rule(t));
    std::array<Members, 2> members;
    std::array<std::vector<int>, 2> sides;
    if (t.between && (!both(t.place, *t.between, members) || !take_particles(by_rule(t), members, sides))) return false;
    const std::size_t before = mistakes_.list().size();
    const std::vector<NewBond> bonds = listed_bonds(t, t.between ? &sides : nullptr, model_, mistakes_);
    if (now) add_bonds(model_, bonds);
    return mistakes_.list().size() == before;
  }

  bool add(const AnglesTable& t, bool now) {
    const Members* over = t.place.broken || !t.over ? nullptr : groups_.find(t.place, "over", *t.over);
    if (t.place.broken || (!over && t.over)) return false;
    const std::size_t before = mistakes_.list().size();
    if (!now && over) return true;                      // of bonds that are not there yet
    const std::vector<NewAngle> angles = listed_angles(t, over ? over->particles : std::vector<int>{}, model_, mistakes_);
    if (now) add_angles(model_, angles);
    return mistakes_.list().size() == before;
  }

 private:
  bool both(const TablePlace& place, const std::array<std::string, 2>& names, std::array<Members, 2>& members) {
    bool found = true;
    for (int side = 0; side < 2; ++side) {
      if (side == 1 && names[1] == names[0]) {
        members[1] = members[0];
        break;
      }
      const Members* group = groups_.find(place, "between", names[side]);
      if (group) members[side] = *group;
      found = found && group;
    }
    return found;
  }

  /// The particles of both sides, which there must be.
  template <class Table>
  bool take_particles(const Table& t, std::array<Members, 2>& members, std::array<std::vector<int>, 2>& particles) {
    constexpr bool contact = requires { t.law; };
    for (int side = 0; side < 2; ++side) {
      if (members[side].particles.empty()) {
        mistakes_.add(t.place, "between", fmt::format("\"{}\" has no particle{}", t.between[side],
                                                      contact ? "; between bodies write law = \"rounded\"" : "; bodies are not connected"));
        return false;
      }
      if constexpr (contact)
        if (t.hard && !members[side].bodies.empty()) {
          mistakes_.add(t.place, "hard", fmt::format("\"{}\" has bodies, which feel no hard contacts; write law = \"rounded\"", t.between[side]));
          return false;
        }
      particles[side] = std::move(members[side].particles);
    }
    return true;
  }

  bool add_rounded(const ContactTable& t, std::array<Members, 2>& members) {
    if (members[0].bodies.empty() && members[1].bodies.empty()) {
      mistakes_.add(t.place, "between", "none of the groups has a body; the law \"rounded\" is between bodies, or a body and particles");
      return false;
    }
    const RoundedKeys& r = t.rounded;
    RoundedPair p;
    p.between = t.between, p.formulation = r.formulation;
    p.kernel = {r.k_n, r.k_na, t.cutoff.value_or(0), r.kernel};
    p.damping = {r.c_n, r.c_t, r.mu, r.slip, r.apart};
    p.unit_area = r.delta_ua.value_or(1);
    for (int side = 0; side < 2; ++side) {
      if (!round(t.place, "between", members[side].particles)) return false;
      p.particles[side] = std::move(members[side].particles), p.bodies[side] = std::move(members[side].bodies);
    }
    model_.rounded.push_back(std::move(p));
    return true;
  }

  /// Whether the group of a wall has what the wall's numbers are of, and the wall can be one of bodies.
  bool can_have(const WallTable& t, const Members& members) {
    bool good = true;
    const auto wrong = [&](const char* key, const std::string& what) { mistakes_.add(t.place, key, what), good = false; };
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
                      called(model_, i) + " has no diameter, which contact needs");
        return false;
      }
    return true;
  }

  Groups& groups_;
  Model& model_;
  Mistakes& mistakes_;
};

class CheckInteractions {
 public:
  CheckInteractions(const Problem& problem, Names& names, Mistakes& mistakes)
      : problem_(problem), names_(names), mistakes_(mistakes) {}

  void check(ConnectTable& c) {
    names_.refer(c.place, "between", c.between);
    if (!c.rest.as_built && !c.place.keys.count("angle_stiffness"))
      mistakes_.add(c.place, "rest", "is of no use without angle_stiffness; without it there are no angles");
  }

  void check(BondsTable& t) {
    if (t.between) names_.refer(t.place, "between", *t.between);
    check_listed(t, mistakes_);
  }
  void check(AnglesTable& t) {
    if (t.over) names_.refer(t.place, "over", *t.over);
    check_listed(t, mistakes_);
  }

  void check(ContactTable& c) {
    const bool whole = !c.place.broken;
    names_.refer(c.place, "between", c.between);
    if (whole && c.inner_cutoff && *c.inner_cutoff >= *c.cutoff)
      mistakes_.add(c.place, "inner_cutoff", fmt::format("is {}, and cutoff is {}; the shell in which the force goes to zero ends there, and begins before",
                                                         *c.inner_cutoff, *c.cutoff));
    if (!whole || c.law != "hertz") return;
    damping(c.place, c.damping);
    if (c.hard) return hard(c.place);
    const bool effective = written(c, "effective_modulus"), E = written(c, "youngs_modulus"),
               nu = written(c, "poissons_ratio");
    if (effective) return only_one(c.place, E, nu);
    if (!E)
      mistakes_.add(c.place, "youngs_modulus",
                    "is missing; give youngs_modulus and poissons_ratio, or effective_modulus");
    else if (!nu)
      mistakes_.add(c.place, "poissons_ratio",
                    "is missing; it must be a number above -1 and at most 0.5, or give effective_modulus alone");
    else if (c.youngs_modulus.size() != c.poissons_ratio.size())
      mistakes_.add(c.place, "poissons_ratio",
                    c.poissons_ratio.size() == 1 ? "is one number for two moduli; give a list of two"
                                                 : "are two numbers for one modulus; give one, or two moduli");
  }

  void check(WallTable& w, const Scaling& scaling) {
    const bool whole = !w.place.broken;
    names_.refer(w.place, "group", w.group);
    if (!whole) return;
    check_region(w.place, w.region, false, mistakes_);
    radius(w, scaling);
    damping(w.place, w.damping);
    if (w.hard) return hard(w.place);
    const bool effective = written(w, "effective_modulus"), E = written(w, "youngs_modulus"),
               nu = written(w, "poissons_ratio");
    if (effective)
      only_one(w.place, E, nu);
    else if (!E && !w.k_n)
      mistakes_.add(w.place, "youngs_modulus", "is missing; it must be a positive number, or give effective_modulus, or k_n for bodies");
  }

 private:
  template <class Table> static bool written(const Table& t, const char* key) { return t.place.keys.count(key) > 0; }

  void only_one(TablePlace& place, bool E, bool nu) {
    if (E) mistakes_.add(place, "effective_modulus", "youngs_modulus is there too; give one of them");
    if (nu && !E) mistakes_.add(place, "poissons_ratio", "is of no use beside effective_modulus; leave it out");
  }

  /// What is impenetrable has no modulus, and only some methods know it.
  void hard(TablePlace& place) {
    for (const char* key : {"youngs_modulus", "poissons_ratio", "effective_modulus"})
      if (place.keys.count(key)) mistakes_.add(place, key, "is of no use with hard = true; what is impenetrable has no modulus");
    if (problem_.in_time())
      mistakes_.add(place, "hard", "cannot be had in dynamics; give it a modulus");
    else if (problem_.study == StudyType::dynamics || problem_.solver.method != "ipopt")
      mistakes_.add(place, "hard", "needs a method for inequality constraints: solver.method = \"ipopt\"");
  }

  void damping(TablePlace& place, const DampingKeys& d) {
    using Model = ContactDamping::Model;
    const auto wrong = [&](const char* key, const char* what) { mistakes_.add(place, key, what); };
    if (d.model == Model::none) {
      if (d.coefficient) wrong("damping_coefficient", "is of no use without damping: \"velocity\", \"mass_velocity\" or \"viscoelastic\"");
      if (d.restitution) wrong("restitution", "is of no use without damping = \"tsuji\"");
      if (d.friction > 0) wrong("friction", "needs damping, which limits it at small sliding velocities");
    } else if (d.model == Model::tsuji) {
      if (d.coefficient) wrong("damping_coefficient", "is not for damping = \"tsuji\", which has restitution");
      if (!d.restitution) wrong("restitution", "is missing; damping = \"tsuji\" needs a number between 0 and 1");
    } else {
      if (d.restitution) wrong("restitution", "is for damping = \"tsuji\" only; give damping_coefficient");
      if (!d.coefficient) wrong("damping_coefficient", "is missing; it must be a number not below 0");
    }
  }

  /// The radius must stay one at every load factor in use.
  void radius(WallTable& w, const Scaling& scaling) {
    if (w.radius_change == 0) return;
    const Region& r = w.region;
    if (r.shape == Shape::plane || r.shape == Shape::block)
      return mistakes_.add(w.place, "radius_change", fmt::format("a {} has no radius; leave it out", name_of(r.shape)));
    const bool cone = r.shape == Shape::cone;
    for (const double lambda : load_factors(problem_)) {
      const double change = scaling.at(lambda) * w.radius_change;
      const double smallest = cone ? std::min(r.radius_lo, r.radius_hi) + change : r.radius + change;
      const double largest = cone ? std::max(r.radius_lo, r.radius_hi) + change : smallest;
      if (smallest >= 0 && largest > 0) continue;
      return mistakes_.add(w.place, "radius_change",
                           fmt::format("makes a radius {} at load factor {}; a radius is {}", smallest, lambda,
                                       cone ? "not negative, and positive at one end at least" : "positive"));
    }
  }

  const Problem& problem_;
  Names& names_;
  Mistakes& mistakes_;
};

}  // namespace

Connection connection_of(const ConnectTable& t) {
  Connection c;
  c.within = t.within.value_or(0), c.bonds_per_particle = t.bonds_per_particle.value_or(0);
  c.bond_stiffness = t.bond_stiffness.value_or(0), c.axial_stiffness = t.axial_stiffness.value_or(0), c.rest_length = t.rest_length.value_or(0);
  c.angle_stiffness = t.angle_stiffness.value_or(0);
  c.as_built = t.rest.as_built, c.rest = rest_angle(t.rest, pi);
  return c;
}

bool add_connections(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  ContactBuilder builder(groups, model, mistakes);
  bool whole = true;
  for (const ConnectTable& t : problem.connections)
    if (stage_number(problem, t.from_stage) == 0) whole = builder.add(t) && whole;
  for (const BondsTable& t : problem.bonds) whole = builder.add(t, stage_number(problem, t.from_stage) == 0) && whole;
  for (const AnglesTable& t : problem.angles) whole = builder.add(t, stage_number(problem, t.from_stage) == 0) && whole;
  return whole;
}

bool add_contacts(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  ContactBuilder builder(groups, model, mistakes);
  bool whole = true;
  for (const ContactTable& t : problem.contacts) whole = builder.add(t) && whole;
  for (std::size_t k = 0; k < problem.walls.size(); ++k)
    whole = builder.add(problem.walls[k], scaling_of(problem, condition_of("wall", problem.walls, k))) && whole;
  return whole;
}

void check_interactions(Problem& problem, Names& names, Mistakes& mistakes) {
  for (WallTable& w : problem.walls) names.add_wall(w.place, w.name);
  CheckInteractions interactions(problem, names, mistakes);
  for (ConnectTable& c : problem.connections) interactions.check(c);
  for (BondsTable& t : problem.bonds) interactions.check(t);
  for (AnglesTable& t : problem.angles) interactions.check(t);
  for (ContactTable& c : problem.contacts) interactions.check(c);
  for (std::size_t k = 0; k < problem.walls.size(); ++k)
    interactions.check(problem.walls[k], scaling_of(problem, condition_of("wall", problem.walls, k)));
}

}  // namespace elamin
