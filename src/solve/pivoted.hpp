#pragma once
#include "solve/block_ldl.hpp"

#include <memory>

namespace elamin {

/// LDLᵀ with 1×1 and 2×2 pivots: of indefinite matrices, with borders, with a reliable inertia (Sylvester's law). There is no factor of what is
/// singular to rounding. Where ranks share their factorisations, by them; else by `block_ldl`; with borders, where that is not stable, or fronts are large, by MUMPS, or small matrices as dense ones (limits::dense).
class PivotedFactor final : public Factorization {
 public:
  /// anywhere: pivots are looked for in all of the matrix, as those of contacts' forces must be, which have no diagonal entries of their own.
  explicit PivotedFactor(bool anywhere = false);

  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override;
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;

 private:
  bool anywhere_, by_blocks_ = false;
  std::unique_ptr<Factorization> shared_;
  BlockLdl blocks_;
  std::unique_ptr<Factorization> any_;                   // for what that has no factor of, where it has been needed since the last pattern
  Factorization* factor_ = nullptr;                      // which of them the last one is
};

}  // namespace elamin
