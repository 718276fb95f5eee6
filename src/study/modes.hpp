#pragma once
// The study "modes": which way an equilibrium gives way first.
#include "path/equilibrium.hpp"
#include "results/mode.hpp"
#include "solve/factors.hpp"
#include "study/trace.hpp"

namespace elamin {

/// Finds the stationary point at the state that the problem starts from (stable or not; zero modes are held) and the
/// modes.count lowest eigenpairs of its Hessian; yields both to sink.modes, or where it does not converge the point
/// reached to sink.point.
Outcome trace_modes(const Problem& problem, Newton& newton, const Sink& sink);

/// The `count` lowest modes at an equilibrium that `assess` has just looked at, eigenvalues ascending. Modes that cost
/// nothing are turned so that those that are rigid motions stand alone and have their name; those of a multiple
/// eigenvalue so that their choice does not depend on rounding (see canonical_modes). Grains that no stiffness holds
/// (Energy::null_dofs) are not among them; Stability::zero_modes names them.
std::vector<Mode> lowest_modes(Newton& newton, const Equilibrium& equilibrium, int count);

// The lowest eigenvalues at the points of a path.

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
