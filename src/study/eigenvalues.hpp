#pragma once
// The lowest eigenvalues at the points of a path.
#include "path/carry.hpp"
#include "solve/factors.hpp"

namespace elamin {

/// Evaluates on an energy of its own, so that the path has the same numbers whether they are asked for or not.
class LowestEigenvalues {
 public:
  /// `count` of them, or all where there are fewer; the model must outlive this.
  LowestEigenvalues(const Model& model, int count) : energy_(model), factors_(energy_), count_(count) {}

  /// Those of the Hessian over the free dofs at a state, ascending [force/length], each as often as it is multiple. The
  /// search begins at the eigenvectors of the state before, with more of them than are asked for: a mode that has become
  /// lower than the others must have been among these.
  std::vector<double> at(const State& state);
  void carry(Archive& archive) { archive(energy_, factors_, before_); }

 private:
  Energy energy_;
  Factors factors_;
  int count_;
  EigenPairs before_;
};

}  // namespace elamin
