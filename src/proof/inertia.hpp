#pragma once
// How many eigenvalues of a symmetric matrix are below a number, as a theorem.
#include "core/types.hpp"

#include <Eigen/SparseCholesky>

namespace elamin::proof {

/// An order of the unknowns that keeps the factor sparse, as Eigen asks for it.
struct FillReducing {
  void operator()(const SparseMatrix& full, Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order) const;
};

/// A factorisation M − σI ≈ LDLᵀ without pivoting, of doubles, with a bound of what rounding has done to it. In whatever order the sums are
/// formed (Higham 2002, theorem 10.3 and lemma 8.4; m: the most entries of a row of L)
///   |M − σI − LDLᵀ| ≤ γ |L||D||L|ᵀ + u |M − σI|,   γ = (m + 4) u/(1 − (m + 4) u),   u = 2⁻⁵³,
/// and ‖|L||D||L|ᵀ‖₂ ≤ ‖|L||D||L|ᵀ 1‖_∞, three products with a vector; whether pivots are large or of both signs does not matter, a bad
/// factor has a bad bound. LDLᵀ has as many negative eigenvalues as D negative entries (Sylvester), and no eigenvalue of M − σI is farther
/// than `error` from its own (Weyl). With k of them at σ:
///   M has n − k eigenvalues > σ − error and k < σ + error.
/// Sources: Rump 2006, "Verification of positive definiteness", BIT 46 (k = 0); Yamamoto 2001, Linear Algebra Appl. 324 (any k).
class ShiftedFactor {
 public:
  /// Takes the pattern: lower triangle with full diagonal.
  explicit ShiftedFactor(const SparseMatrix& pattern) { factor_.analyzePattern(pattern); }
  /// False if a pivot is zero or not finite.
  [[nodiscard]] bool factorize(const SparseMatrix& M, double shift);
  int negative() const { return negative_; }
  double error() const { return error_; }
  Vector solve(const Vector& b) const { return factor_.solve(b); }

 private:
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, FillReducing> factor_;
  int negative_ = 0;
  double error_ = 0;
};

/// A bound `least` so that M has exactly `negative` eigenvalues ≤ −least and all others are ≥ least; 0: none was found. `shift`: the σ
/// it took.
struct Spectrum {
  int negative = 0;
  double least = 0, shift = 0, error = 0, estimate = 0;   // estimate: of the size of the eigenvalue next to zero, no bound
};
Spectrum spectrum_near_zero(const SparseMatrix& M);

}  // namespace elamin::proof
