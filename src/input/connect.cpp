#include "input/connect.hpp"

namespace elamin {

namespace {

constexpr Word<RemoveTable::What> remove_words[]{
    {"particles", RemoveTable::What::particles}, {"bonds", RemoveTable::What::bonds}, {"angles", RemoveTable::What::angles}};

}  // namespace

void describe(Keys& keys, ConnectTable& t) {
  keys.about("Bonds between the particles of two groups that are near each other, and angles over these bonds.");
  keys.must("between", t.between, "the two groups");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.must("within", t.within, "the longest distance that is bonded [length]", range::positive);
  keys.may("bonds_per_particle", t.bonds_per_particle, "of the first group: to its nearest ones only; by default to all", range::count);
  keys.must("bond_stiffness", t.bond_stiffness, "K of the bonds [force/length]", range::positive);
  keys.may("rest_length", t.rest_length, "r₀ of the bonds [length]; by default the distance as built", range::positive);
  keys.may("angle_stiffness", t.angle_stiffness, "B of the angles [energy]; by default there are none", range::positive);
  keys.may("rest", t.rest, "θ₀ of the angles", range::degrees);
}

void describe(Keys& keys, RemoveTable& t) {
  keys.about("What is gone from a stage on.");
  keys.must("group", t.group, "where");
  keys.must("from_stage", t.from_stage, "the stage from which it is gone");
  keys.word("what", t.what, remove_words, "the particles with all that is on them; the bonds between them with the angles over these; the angles");
}

}  // namespace elamin
