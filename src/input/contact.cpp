#include "input/contact.hpp"

#include "dynamics/contact_damping.hpp"
#include "input/parts.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr std::array law_words{"hertz", "lj", "rounded"};
constexpr Word<CutoffStyle> cutoff_style_words[]{{"cut", CutoffStyle::cut}, {"shifted", CutoffStyle::shifted}, {"smooth", CutoffStyle::smooth}};
constexpr Word<RoundedFormulation> formulation_words[]{
    {"multi", RoundedFormulation::multi}, {"closest", RoundedFormulation::closest}, {"lammps", RoundedFormulation::lammps}};
constexpr Word<RoundedKernel::Form> kernel_words[]{{"lammps", RoundedKernel::Form::coded}, {"printed", RoundedKernel::Form::printed}};
constexpr Word<bool> rounded_damping_words[]{{"coded", false}, {"printed", true}};
constexpr Word<ContactDamping::Model> damping_words[]{{"none", ContactDamping::Model::none},
                                                      {"velocity", ContactDamping::Model::velocity},
                                                      {"mass_velocity", ContactDamping::Model::mass_velocity},
                                                      {"viscoelastic", ContactDamping::Model::viscoelastic},
                                                      {"tsuji", ContactDamping::Model::tsuji}};

void describe_hertz(Keys& keys, ContactTable& t) {
  keys.one_or_two("youngs_modulus", t.youngs_modulus, "E [force/length²]", range::positive);
  keys.one_or_two("poissons_ratio", t.poissons_ratio, "ν: E_eff = ((1 − ν₁²)/E₁ + (1 − ν₂²)/E₂)⁻¹", range::poissons_ratio);
  keys.may("effective_modulus", t.effective_modulus, "E_eff itself [force/length²]", range::not_negative);
  keys.may("hard", t.hard, "impenetrable instead of elastic");
  describe_damping(keys, t.damping);
}

void describe_cohesion(Keys& keys, ContactTable& t) {
  keys.must("epsilon", t.epsilon, "ε of 4ε((σ/r)¹² − (σ/r)⁶) [energy]", range::not_negative);
  keys.must("sigma", t.sigma, "σ [length]", range::positive);
  keys.must("cutoff", t.cutoff, "where it ends [length]", range::positive);
  keys.word("cutoff_style", t.cutoff_style, cutoff_style_words,
            "how it ends there: cut off, shifted to zero energy, or with a force that goes to zero");
  keys.either("cutoff_style", {{{"smooth"}, "cutoff_style \"smooth\"", t.cutoff_style == CutoffStyle::smooth,
                                [&] {
                                  keys.must("inner_cutoff", t.inner_cutoff, "from where on the force goes to zero [length]", range::positive);
                                }},
                               {{"cut", "shifted"}, "this cutoff_style; it is for \"smooth\", whose force goes to zero from there on",
                                t.cutoff_style != CutoffStyle::smooth, [] {}}});
}

void describe_rounded(Keys& keys, ContactTable& t) {
  RoundedKeys& r = t.rounded;
  keys.must("k_n", r.k_n, "stiffness of overlaps [force/length]", range::not_negative);
  keys.may("k_na", r.k_na, "of attraction within the cutoff [force/length]", range::not_negative);
  keys.may("cutoff", t.cutoff, "of the separation of surfaces [length]; the same in all such tables", range::not_negative);
  keys.word("formulation", r.formulation, formulation_words,
            "a sum over features, the closest points alone, or LAMMPS's rules, which have no energy");
  keys.may("mu", r.mu, "friction", range::not_negative);
  keys.may("c_n", r.c_n, "damping along the normal [force·time/length]", range::not_negative);
  keys.may("c_t", r.c_t, "damping across it [force·time/length]", range::not_negative);
  const bool lammps = r.formulation == RoundedFormulation::lammps;
  keys.either("formulation", {{{"multi", "closest"}, "the formulation of a potential", !lammps, [&] {
                                 keys.word("kernel", r.kernel, kernel_words, "the force as LAMMPS has it, or as it is printed");
                                 keys.may("slip", r.slip, "η of the friction of the potentials [force·time/length]", range::not_negative);
                                 keys.word("damping", r.apart, rounded_damping_words, "on overlap, or within the cutoff");
                               }},
                              {{"lammps"}, "formulation \"lammps\"", lammps,
                               [&] { keys.may("delta_ua", r.delta_ua, "of LAMMPS's rules; by default 1", range::positive); }}});
}

}  // namespace

void describe_damping(Keys& keys, DampingKeys& d) {
  keys.word("damping", d.model, damping_words, "in dynamics, along the normal");
  keys.may("damping_coefficient", d.coefficient, "γ of it", range::not_negative);
  keys.may("restitution", d.restitution, "of tsuji: what it stands for instead", Range{0, 1});
  keys.may("friction", d.friction, "μ, in dynamics", range::not_negative);
  keys.may("friction_damping", d.friction_damping, "damping across the normal, of that along it", range::not_negative);
}

void describe(Keys& keys, ContactTable& t) {
  keys.about("Contact or cohesion between two groups, or within one.");
  keys.must("between", t.between, "the two groups; one name twice: with itself");
  keys.may("from_stage", t.from_stage, "the stage it is in force from; by default from the start");
  // Other keys belong to other laws.
  if (!keys.word("law", t.law, law_words, "elastic spheres, cohesion, or rounded bodies")) return keys.skip_the_rest();
  const auto exclude = [&] {
    keys.may("exclude_bonds", t.exclude_bonds,
             "pairs within this many bonds of each other feel nothing; by default as many as overlap at their rest lengths, and at least 1",
             Range{0, 1000});
  };
  keys.either("law", {{{"hertz"}, "law \"hertz\"", t.law == "hertz", [&] { describe_hertz(keys, t), exclude(); }},
                      {{"lj"}, "law \"lj\"", t.law == "lj", [&] { describe_cohesion(keys, t), exclude(); }},
                      {{"rounded"}, "law \"rounded\"", t.law == "rounded", [&] { describe_rounded(keys, t); }}});
}

void check_damping(TablePlace& place, const DampingKeys& d, Mistakes& mistakes) {
  using Way = ContactDamping::Model;
  const auto wrong = [&](const char* key, const char* what) { mistakes.add(place, key, what); };
  if (d.model == Way::none) {
    if (d.coefficient) wrong("damping_coefficient", "is of no use without damping: \"velocity\", \"mass_velocity\" or \"viscoelastic\"");
    if (d.restitution) wrong("restitution", "is of no use without damping = \"tsuji\"");
    if (d.friction > 0) wrong("friction", "needs damping, which limits it at small sliding velocities");
  } else if (d.model == Way::tsuji) {
    if (d.coefficient) wrong("damping_coefficient", "is not for damping = \"tsuji\", which has restitution");
    if (!d.restitution) wrong("restitution", "is missing; damping = \"tsuji\" needs a number between 0 and 1");
  } else {
    if (d.restitution) wrong("restitution", "is for damping = \"tsuji\" only; give damping_coefficient");
    if (!d.coefficient) wrong("damping_coefficient", "is missing; it must be a number not below 0");
  }
}

void check_hard(const Problem& problem, TablePlace& place, Mistakes& mistakes) {
  for (const char* key : {"youngs_modulus", "poissons_ratio", "effective_modulus"})
    if (place.written(key)) mistakes.add(place, key, "is of no use with hard = true; what is impenetrable has no modulus");
  if (problem.in_time())
    mistakes.add(place, "hard", "cannot be had in dynamics; give it a modulus");
  else if (problem.study == StudyType::dynamics || problem.solver.method != "ipopt")
    mistakes.add(place, "hard", "needs a method for inequality constraints: solver.method = \"ipopt\"");
}

bool has_effective_modulus(TablePlace& place, Mistakes& mistakes) {
  if (!place.written("effective_modulus")) return false;
  const bool E = place.written("youngs_modulus");
  if (E) mistakes.add(place, "effective_modulus", "youngs_modulus is there too; give one of them");
  if (place.written("poissons_ratio") && !E) mistakes.add(place, "poissons_ratio", "is of no use beside effective_modulus; leave it out");
  return true;
}

void check_potential(const Problem& problem, TablePlace& place, const char* why, Mistakes& mistakes) {
  const bool minimises = problem.study == StudyType::equilibrium || problem.follows_path() ||
                         problem.study == StudyType::modes || (problem.study == StudyType::dynamics && problem.dynamics.relax);
  if (minimises) mistakes.add(place, "formulation", why);
}

namespace {

void check_hertz(const Problem& problem, ContactTable& c, Mistakes& mistakes) {
  check_damping(c.place, c.damping, mistakes);
  if (c.hard) return check_hard(problem, c.place, mistakes);
  if (has_effective_modulus(c.place, mistakes)) return;
  if (!c.place.written("youngs_modulus"))
    mistakes.add(c.place, "youngs_modulus", "is missing; give youngs_modulus and poissons_ratio, or effective_modulus");
  else if (!c.place.written("poissons_ratio"))
    mistakes.add(c.place, "poissons_ratio", "is missing; it must be a number above -1 and at most 0.5, or give effective_modulus alone");
  else if (c.youngs_modulus.size() != c.poissons_ratio.size())
    mistakes.add(c.place, "poissons_ratio",
                 c.poissons_ratio.size() == 1 ? "is one number for two moduli; give a list of two"
                                              : "are two numbers for one modulus; give one, or two moduli");
}

void check_rounded(const Problem& problem, ContactTable& c, Mistakes& mistakes) {
  const RoundedKeys& r = c.rounded;
  if (r.k_na > 0 && !c.cutoff)
    mistakes.add(c.place, "cutoff", "is missing; it must be a positive number, within which k_na attracts");
  if (r.formulation == RoundedFormulation::lammps)
    return check_potential(problem, c.place, "\"lammps\" has no potential: its forces are no gradient of an energy; take formulation = "
                                             "\"multi\" or \"closest\"", mistakes);
  if (r.mu > 0 && r.slip == 0)
    mistakes.add(c.place, "slip", "is missing; it must be a positive number, the damping that takes the place of friction mu at small "
                                  "sliding velocities");
}

}  // namespace

void check_contacts(Problem& problem, Names& names, Mistakes& mistakes) {
  const ContactTable* first = nullptr;                // of the law "rounded"
  for (ContactTable& c : problem.contacts) {
    const bool whole = !c.place.broken;
    names.refer(c.place, "between", c.between);
    if (whole && c.inner_cutoff && *c.inner_cutoff >= *c.cutoff)
      mistakes.add(c.place, "inner_cutoff", fmt::format("is {}, and cutoff is {}; the shell in which the force goes to zero ends there, and begins before",
                                                        *c.inner_cutoff, *c.cutoff));
    if (whole && c.law == "hertz") check_hertz(problem, c, mistakes);
    if (c.place.broken || c.law != "rounded") continue;
    check_rounded(problem, c, mistakes);
    if (!first) first = &c;
    else if (c.cutoff.value_or(0) != first->cutoff.value_or(0))
      mistakes.add(c.place, "cutoff", fmt::format("is {}, and that of {} is {}; all tables with law \"rounded\" have one cutoff",
                                                  c.cutoff.value_or(0), named(first->place), first->cutoff.value_or(0)));
  }
}

ContactDamping damping_of(const DampingKeys& keys) {
  ContactDamping d{keys.model, keys.coefficient.value_or(0), keys.friction_damping, keys.friction};
  if (d.model == ContactDamping::Model::tsuji) d.coefficient = tsuji_coefficient(*keys.restitution);
  return d;
}

bool is_finite_modulus(const TablePlace& place, double modulus, Mistakes& mistakes) {
  if (!std::isfinite(modulus)) mistakes.add(place, "its effective modulus is beyond what numbers can hold");
  return std::isfinite(modulus);
}

bool are_spheres(const TablePlace& place, const char* key, const std::vector<int>& particles, const Model& model, Mistakes& mistakes) {
  const auto flat = std::find_if(particles.begin(), particles.end(), [&](int i) { return !(model.diameter[i] > 0); });
  if (flat != particles.end()) mistakes.add(place, key, called(model, *flat) + " has no diameter, which contact needs");
  return flat == particles.end();
}

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

bool add_rounded(const ContactTable& t, std::array<Members, 2>& members, Model& model, Mistakes& mistakes) {
  if (members[0].bodies.empty() && members[1].bodies.empty()) {
    mistakes.add(t.place, "between", "none of the groups has a body; the law \"rounded\" is between bodies, or a body and particles");
    return false;
  }
  const RoundedKeys& r = t.rounded;
  RoundedPair p;
  p.between = t.between, p.formulation = r.formulation;
  p.kernel = {r.k_n, r.k_na, t.cutoff.value_or(0), r.kernel};
  p.damping = {r.c_n, r.c_t, r.mu, r.slip, r.apart};
  p.unit_area = r.delta_ua.value_or(1);
  for (int side = 0; side < 2; ++side) {
    if (!are_spheres(t.place, "between", members[side].particles, model, mistakes)) return false;
    p.particles[side] = std::move(members[side].particles), p.bodies[side] = std::move(members[side].bodies);
  }
  model.rounded.push_back(std::move(p));
  return true;
}

bool add_contact(const ContactTable& t, Groups& groups, Model& model, Mistakes& mistakes) {
  std::optional<std::array<Members, 2>> members = groups.find(t.place, t.between);
  if (!members) return false;
  if (t.law == "rounded") return add_rounded(t, *members, model, mistakes);
  PairContact c;
  c.between = t.between, c.exclude_bonds = t.exclude_bonds;
  for (int side = 0; side < 2; ++side) {
    const auto refuse = [&](const char* key, const char* what) { mistakes.add(t.place, key, fmt::format("\"{}\" {}", t.between[side], what)); };
    Members& of = (*members)[side];
    if (of.particles.empty()) return refuse("between", "has no particle; between bodies write law = \"rounded\""), false;
    if (t.hard && !of.bodies.empty()) return refuse("hard", "has bodies, which feel no hard contacts; write law = \"rounded\""), false;
    c.particles[side] = std::move(of.particles);
  }
  if (t.law == "lj") {
    c.law = PairContact::Law::lj;
    c.epsilon = *t.epsilon, c.sigma = *t.sigma, c.cutoff = *t.cutoff;
    c.cutoff_style = t.cutoff_style, c.inner_cutoff = t.inner_cutoff.value_or(0);
  } else {
    c.hard = t.hard, c.damping = damping_of(t.damping);
    c.effective_modulus = t.hard ? 0 : effective_modulus(t);
    if (!is_finite_modulus(t.place, c.effective_modulus, mistakes)) return false;
    for (const auto& side : c.particles)
      if ((c.hard || c.effective_modulus > 0) && !are_spheres(t.place, "between", side, model, mistakes)) return false;
  }
  model.contacts.push_back(std::move(c));
  return true;
}

}  // namespace

bool add_contacts(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  for (const ContactTable& t : problem.contacts) whole = add_contact(t, groups, model, mistakes) && whole;
  return whole;
}

}  // namespace elamin
