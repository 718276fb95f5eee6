#pragma once
// Which bonds and angles the changes of a model act on, and how much they are changed.
#include "core/exact.hpp"
#include "model/model.hpp"

#include <vector>

namespace elamin {

/// Elements of one type on which the same changes act are of one kind. First every type's own kind, unchanged.
struct Kinds {
  std::vector<int> type;                        // of each kind
  std::vector<std::vector<int>> changes;        // of each kind: those that act on it, by index
  std::vector<int> of;                          // of each element: its kind
  bool changed() const { return !changes.empty() && !changes.back().empty(); }
};
Kinds bond_kinds(const Model& model);
Kinds angle_kinds(const Model& model);

/// 1 + Σ s(λ) c of these changes, to about 30 digits, where `part` is one of Change's numbers c.
Exact change_factor(const Model& model, const std::vector<int>& changes, double Change::*part, double load_factor);
/// Its derivative Σ s′ c.
double change_rate(const Model& model, const std::vector<int>& changes, double Change::*part);

}  // namespace elamin
