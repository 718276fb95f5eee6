#include "input/connect.hpp"

namespace elamin {

namespace {

constexpr Word<RemoveTable::What> remove_words[]{
    {"particles", RemoveTable::What::particles}, {"bonds", RemoveTable::What::bonds}, {"angles", RemoveTable::What::angles}};
constexpr Word<BondRule> rule_words[]{{"nearest", BondRule::nearest}, {"within", BondRule::within}};

void describe_new_bonds(Keys& keys, NewBondKeys& t) {
  keys.may("bond_stiffness", t.bond_stiffness, "K of the bonds [force/length]", range::positive);
  keys.may("axial_stiffness", t.axial_stiffness, "EA [force] instead of it: K = EA/(2 r₀) of each", range::positive);
  keys.may("rest_length", t.rest_length, "r₀ of the bonds [length]; by default the distance as built", range::positive);
  keys.at_most_one({"bond_stiffness", "axial_stiffness"});
}

}  // namespace

void describe(Keys& keys, ConnectTable& t) {
  keys.about("Bonds between the particles of two groups that are near each other, and angles over these bonds.");
  keys.must("between", t.between, "the two groups");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.must("within", t.within, "the longest distance that is bonded [length]", range::positive);
  keys.may("bonds_per_particle", t.bonds_per_particle, "of the first group: to its nearest ones only; by default to all", range::count);
  describe_new_bonds(keys, t);
  keys.one_at_least({"bond_stiffness", "axial_stiffness"}, "it must be a positive number");
  keys.may("angle_stiffness", t.angle_stiffness, "B of the angles [energy]; by default there are none", range::positive);
  keys.may("rest", t.rest, "θ₀ of the angles", range::degrees);
}

void describe(Keys& keys, BondsTable& t) {
  keys.about("Bonds besides those of the structures: one by one, or by a rule. (With angles over them: `[[connect]]`.)");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.may("pairs", t.pairs, "the two particles of each, by their ids, or with `between` by their places in the two groups, from 1");
  keys.may_file("file", t.file, "the same from a table of commas: i,j; its first line may name columns bond_stiffness and rest_length too, an empty "
                                "cell: as by the keys");
  keys.word("rule", t.rule, rule_words, "each particle of the first group with its nearest ones in the second, or with all within a distance");
  keys.may("between", t.between, "the two groups; by default all");
  keys.may("within", t.within, "the longest distance that is bonded by the rule [length]", range::positive);
  keys.may("bonds_per_particle", t.bonds_per_particle, "of the first group, by the rule: to so many nearest ones", range::count);
  describe_new_bonds(keys, t);
  keys.at_most_one({"pairs", "file", "rule"});
  keys.one_at_least({"pairs", "file", "rule"}, "give pairs = [[i, j], …], file = \"bonds.csv\" or rule = \"nearest\"");
  keys.with({"within", "bonds_per_particle"}, {"rule"}, "which looks for neighbours");
}

void describe(Keys& keys, AnglesTable& t) {
  keys.about("Angles besides those of the structures: one by one, or over bonds that meet.");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.may("triples", t.triples, "the three particles of each by their ids, the middle one second");
  keys.may_file("file", t.file, "the same from a table of commas: i,j,k; its first line may name columns angle_stiffness and rest (degrees) too, an "
                                "empty cell: as by the keys");
  keys.may("over", t.over, "a group: over every two bonds that meet in a particle, all three of the group");
  keys.may("least", t.least, "… at this angle or more [degrees]: 120 leaves out those that do not go on", range::degrees);
  keys.may("angle_stiffness", t.angle_stiffness, "B of the angles [energy]; needed unless the file has it", range::positive);
  keys.may("rest", t.rest, "θ₀ of the angles", range::degrees);
  keys.at_most_one({"triples", "file", "over"});
  keys.one_at_least({"triples", "file", "over"}, "give triples = [[i, j, k], …], file = \"angles.csv\" or over = \"group\"");
  keys.with({"least"}, {"over"}, "the bonds that meet");
}

ConnectTable by_rule(const BondsTable& t) {
  ConnectTable c;
  static_cast<NewBondKeys&>(c) = t;
  c.place = t.place, c.from_stage = t.from_stage;
  c.between = t.between.value_or(std::array<std::string, 2>{"all", "all"});
  c.within = t.within, c.bonds_per_particle = t.bonds_per_particle;
  return c;
}

void describe(Keys& keys, RemoveTable& t) {
  keys.about("What is gone from a stage on.");
  keys.must("group", t.group, "where");
  keys.must("from_stage", t.from_stage, "the stage from which it is gone");
  keys.word("what", t.what, remove_words, "the particles with all that is on them; the bonds between them with the angles over these; the angles");
}

}  // namespace elamin
