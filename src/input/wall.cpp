#include "input/wall.hpp"

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

}  // namespace elamin
