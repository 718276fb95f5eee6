#pragma once
#include "core/types.hpp"

#include <memory>

namespace elamin {

/// LDLᵀ of an indefinite H + τI with 1×1 and 2×2 pivots (MUMPS): solves, and a reliable inertia (Sylvester's law).
/// Analysis once per pattern. MUMPS serves one caller at a time; calls from several threads wait for each other.
class PivotedFactor {
 public:
  PivotedFactor();
  ~PivotedFactor();
  PivotedFactor(const PivotedFactor&) = delete;
  PivotedFactor& operator=(const PivotedFactor&) = delete;

  /// Takes the pattern (lower triangle with full diagonal).
  void analyze(const SparseMatrix& pattern);
  /// Factorises H + shift·I. False if it is singular to rounding: negative() and solve() then mean nothing.
  bool factorize(const SparseMatrix& hessian, double shift = 0);
  /// Number of negative eigenvalues of the matrix factorised last.
  int negative() const;
  /// (H + shift·I)⁻¹ b.
  Vector solve(const Vector& b);
  /// Time spent in all calls so far, waiting for other threads included.
  double seconds() const { return seconds_; }

 private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
  double seconds_ = 0;
};

}  // namespace elamin
