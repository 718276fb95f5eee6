#pragma once
// Eigenvalues by a dense solver.
#include "core/dense.hpp"
#include "energy/energy.hpp"

namespace elamin {

/// All eigenvalues of the Hessian at a state, ascending.
inline Vector spectrum(Energy& energy, const State& state) {
  energy.evaluate(state);
  const Eigen::MatrixXd lower = energy.hessian();
  return symmetric_eigen(lower.selfadjointView<Eigen::Lower>()).values;
}

}  // namespace elamin
