#pragma once
#include "solve/factorization.hpp"

#include <vector>

namespace elamin {

/// LDLᵀ with 1×1 and 2×2 pivots of small matrices, as dense ones (LAPACK's dsytrf_rook): n³/3 operations, but no tree and no lists.
/// Source: Ashcraft, Grimes & Lewis 1998, SIAM J. Matrix Anal. Appl. 20, 513 (bounded Bunch–Kaufman pivoting, whose L stays bounded).
class BunchKaufman final : public Factorization {
 public:
  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override { return negative_; }
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;

 private:
  Eigen::MatrixXd matrix_;                       // its lower triangle; after factorize L and D
  std::vector<int> pivots_;
  std::vector<double> work_;
  int negative_ = 0;
};

}  // namespace elamin
