#include "input/contact.hpp"

namespace elamin {

namespace {

constexpr Word<const char*> law_words[]{{"hertz", "hertz"}, {"lj", "lj"}, {"rounded", "rounded"}};
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

}  // namespace elamin
