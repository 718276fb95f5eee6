#pragma once
#include "core/types.hpp"

#include <memory>

namespace elamin {

/// LLᵀ of H + τI by CHOLMOD (supernodal where that pays): ordering and symbolic analysis once per pattern.
/// Succeeds if and only if the matrix is positive definite to rounding; of an indefinite one it knows no more.
class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Takes the pattern (lower triangle); it must stay the same until the next call.
  void analyze(const SparseMatrix& pattern);
  /// True if H + shift·I is positive definite; then solve() may be called.  shift [force/length]
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0);
  /// (H + shift·I)⁻¹ b.
  Vector solve(const Vector& b);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);
  /// W b and Wᵀ b of a square root of the inverse, W Wᵀ = (H + shift·I)⁻¹: W = Qᵀ L⁻ᵀ, Q the ordering.
  Vector root(const Vector& b);
  Vector root_transposed(const Vector& b);
  /// Time spent in all calls so far.
  double seconds() const { return seconds_; }

 private:
  struct Cholmod;
  Eigen::MatrixXd solve(int system, const Eigen::MatrixXd& b);
  std::unique_ptr<Cholmod> cholmod_;
  double seconds_ = 0;
};

}  // namespace elamin
