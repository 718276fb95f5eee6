#pragma once
// Bonds and angles besides those of the structures, and what is removed.
#include "input/keys.hpp"

namespace elamin {

/// How stiff new bonds are, and how long at rest.
struct NewBondKeys {
  std::optional<double> bond_stiffness, axial_stiffness, rest_length;
  bool operator==(const NewBondKeys&) const = default;
};

/// Bonds between the particles of two groups that are near each other, and angles over these bonds.
struct ConnectTable : NewBondKeys {
  TablePlace place;
  std::string from_stage;
  std::array<std::string, 2> between;
  std::optional<double> within;                 // none: the nearest, however far
  std::optional<int> bonds_per_particle;
  std::optional<double> angle_stiffness;
  Rest rest{true, 180};
  bool operator==(const ConnectTable&) const = default;
};

enum class BondRule { nearest, within };

/// Bonds one by one, or by a rule, as [[connect]] has it.
struct BondsTable : NewBondKeys {
  TablePlace place;
  std::string from_stage;
  std::optional<std::vector<std::vector<int>>> pairs;   // either these …
  std::string file;                                     // … or these …
  std::optional<BondRule> rule;                         // … or by this
  std::optional<std::array<std::string, 2>> between;
  std::optional<double> within;
  std::optional<int> bonds_per_particle;
  bool operator==(const BondsTable&) const = default;
};

struct AnglesTable {
  TablePlace place;
  std::string from_stage;
  std::optional<std::vector<std::vector<int>>> triples;
  std::string file;
  std::optional<std::string> over;
  std::optional<double> least;                  // [degrees]
  std::optional<double> angle_stiffness;
  Rest rest{true, 180};
  bool operator==(const AnglesTable&) const = default;
};

/// What is gone from a stage on.
struct RemoveTable {
  enum class What { particles, bonds, angles };
  TablePlace place;
  std::string group, from_stage;
  What what = What::particles;
  bool operator==(const RemoveTable&) const = default;
};

void describe(Keys& keys, ConnectTable& t);
void describe(Keys& keys, BondsTable& t);
void describe(Keys& keys, AnglesTable& t);
void describe(Keys& keys, RemoveTable& t);

/// The connection that a rule asks for.
ConnectTable by_rule(const BondsTable& t);

}  // namespace elamin
