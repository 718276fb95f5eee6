#pragma once
#include "core/types.hpp"

#include <memory>
#include <mutex>

namespace elamin {

/// Held by the thread that uses MUMPS, or what uses it inside: the library keeps global state.
std::recursive_mutex& one_at_a_time();

/// LDLᵀ with 1×1 and 2×2 pivots (MUMPS) of an indefinite H + τI, or of H with borders Z (n × m),
///   [ H   sZ ]
///   [ sZᵀ  0 ] ,   s = max |H|:
/// solves, and a reliable inertia (Sylvester's law).
/// Analysis once per pattern. MUMPS serves one caller at a time; calls from several threads wait for each other.
class PivotedFactor {
 public:
  PivotedFactor();
  ~PivotedFactor();
  PivotedFactor(const PivotedFactor&) = delete;
  PivotedFactor& operator=(const PivotedFactor&) = delete;

  /// Takes the pattern (lower triangle with full diagonal), and how many borders there will be.
  void analyze(const SparseMatrix& pattern, int borders = 0);
  /// Factorises H + shift·I. False if it is singular to rounding: negative() and solve() then mean nothing.
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {});
  /// Number of negative eigenvalues of the matrix factorised last. With borders that are independent, m of them belong to
  /// the borders: the others are those of H among the vectors orthogonal to Z.
  int negative() const;
  /// (H + shift·I)⁻¹ b; with borders p of H p + Z μ = b, Zᵀ p = 0.
  Vector solve(const Vector& b);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);
  /// Time spent in all calls so far, waiting for other threads included.
  double seconds() const { return seconds_; }

 private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
  double seconds_ = 0;
};

}  // namespace elamin
