#pragma once
// The pairs that are near enough to feel each other before anything has moved far.
#include "core/near_pairs.hpp"
#include "core/archive.hpp"
#include "energy/contact_rules.hpp"

#include <array>

namespace elamin {

/// Candidate pairs: all that feel each other or bear a hard contact's force, and all that would if every particle moved by half the skin.
/// The skin is 0.3 of the smallest diameter in any table, or that diameter itself where there are hard contacts, whose
/// methods are begun anew with every new list. Not rebuilt without need: while nothing has moved by half the
/// skin the list holds, and a new list that is part of the old one changes nothing.
class Neighbours {
 public:
  explicit Neighbours(const Model& model);

  const ContactRules& rules() const { return rules_; }
  /// Whether the list still holds every pair that feels each other at the state, and every one with a gap of at most `within` [length].
  bool covers(const State& state, double within = 0) const;
  /// Makes the list hold for the state. True if the candidates have changed.
  bool refresh(const State& state);
  /// Pairs with a Hertz table that is not hard, pairs with a Lennard-Jones table, and hard pairs, ascending.
  const std::vector<IndexPair>& hertz() const { return pairs_[0]; }
  const std::vector<IndexPair>& lj() const { return pairs_[1]; }
  const std::vector<IndexPair>& hard() const { return pairs_[2]; }
  /// How far every particle may move before the list must be looked at anew; infinity without tables. [length]
  double freedom() const { return rules_.any() ? skin_ / 2 : infinity; }
  /// The list, whose order sums follow.
  void carry(Archive& archive) { archive(listed_, pairs_); }

 private:
  const Model& model_;
  ContactRules rules_;
  double skin_ = 0;
  State listed_;                                 // where the list was made
  std::array<std::vector<IndexPair>, 3> pairs_;
};

}  // namespace elamin
