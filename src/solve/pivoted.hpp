#pragma once
#include "solve/factorization.hpp"

#include <memory>

namespace elamin {

/// LDLᵀ with 1×1 and 2×2 pivots: of indefinite matrices, with borders, with a reliable inertia (Sylvester's law). There is no factor of what is
/// singular to rounding. Small matrices are factorised as dense ones (limits::dense), others by MUMPS.
class PivotedFactor final : public Factorization {
 public:
  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override;
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;

 private:
  std::unique_ptr<Factorization> factor_;        // of the last pattern
};

}  // namespace elamin
