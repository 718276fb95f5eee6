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
  bool factorize(const SparseMatrix& hessian, double shift = 0);
  /// (H + shift·I)⁻¹ b.
  Vector solve(const Vector& b);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);
  /// Time spent in all calls so far.
  double seconds() const { return seconds_; }

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
  double seconds_ = 0;
};

}  // namespace elamin
