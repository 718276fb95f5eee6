#pragma once
// A factorisation whose matrix and numbers are spread over the ranks. Each member is called by all of them at the same time.
#include "core/types.hpp"

#include <petscksp.h>

#include <string>
#include <vector>

namespace elamin {

/// Ends all ranks with PETSc's sentence: after an error of one of them the others would wait without end.
void must(PetscErrorCode error);

/// The upper triangle of a symmetric matrix by rows, the diagonal entry of each row first, as rank 0 has it; empty on the others.
struct UpperRows {
  std::vector<int> starts, columns;
  int rows() const { return static_cast<int>(starts.size()) - 1; }
};

class SharedFactor {
 public:
  enum class Outcome : int { made, none, no_memory };

  /// definite: of positive definite matrices alone.
  explicit SharedFactor(bool definite);
  ~SharedFactor();
  SharedFactor(const SharedFactor&) = delete;
  SharedFactor& operator=(const SharedFactor&) = delete;

  /// Deals the rows out, as many entries to each rank. near_null, of rank 0: motions that cost next to nothing (rows × any number), for multigrid.
  void set_pattern(const UpperRows& whole, const Eigen::MatrixXd& near_null);
  /// values: of rank 0, in the pattern's order. none: singular to rounding, or not definite where it was to be.
  [[nodiscard]] Outcome factorize(const std::vector<double>& values);
  int negative() const { return negative_; }
  /// Whether PETSc's options ask for an iteration where a factor of a positive definite matrix would be.
  bool iterates() const { return !direct_; }
  /// Of the whole matrix, on rank 0.
  int rows() const { return row_at_.empty() ? 0 : row_at_.back(); }
  /// x of A x = b, a column of rank 0, of the pattern's rows; zero where an iteration does not converge.
  Vector solve(const Vector& b);
  /// Eigenvectors to the `count` lowest eigenvalues of A, by SLEPc's Krylov–Schur method for A⁻¹, rows × up to count on rank 0: none that had not
  /// converged. A must be positive definite.
  Eigen::MatrixXd lowest(int count);

 private:
  void drop_matrix();
  Outcome outcome_of_direct();
  Vector gathered(Vec v) const;
  bool definite_, direct_ = true;
  int first_ = 0;                                // row of this rank
  std::vector<int> starts_, columns_;            // of its rows
  std::vector<int> rows_of_, entries_of_, row_at_, entry_at_;      // of each rank, on rank 0
  Mat matrix_ = nullptr, spread_ = nullptr;      // the upper triangle; both, where an iteration wants them
  MatNullSpace near_null_ = nullptr;
  Vec b_ = nullptr, x_ = nullptr;
  KSP solver_ = nullptr;
  int negative_ = 0;
};

}  // namespace elamin
