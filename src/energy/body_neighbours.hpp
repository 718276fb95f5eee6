#pragma once
// The pairs with a rigid body in them that are near enough to feel each other before anything has moved far.
#include "core/near_pairs.hpp"
#include "energy/body_rules.hpp"
#include "core/archive.hpp"

namespace elamin {

/// Candidate pairs of entities (see BodyRules), by their bounding spheres, which no rotation changes: all that may feel each other
/// while nothing moves by more than half the skin, 0.2 of the smallest cutoff in any table. A new list that is part of the
/// old one changes nothing.
class BodyNeighbours {
 public:
  explicit BodyNeighbours(const Model& model);

  const BodyRules& rules() const { return rules_; }
  /// Whether the list still holds every pair that feels each other at the state.
  bool covers(const State& state) const;
  /// Makes the list hold for the state. True if the candidates have changed.
  bool refresh(const State& state);
  /// The list by entities, ascending.
  const std::vector<IndexPair>& pairs() const { return pairs_; }
  void carry(Archive& archive) { archive(listed_, pairs_); }

 private:
  BodyRules rules_;
  double skin_ = 0;
  Field listed_;
  std::vector<IndexPair> pairs_;
};

}  // namespace elamin
