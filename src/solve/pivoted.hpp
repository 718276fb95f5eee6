#pragma once
#include "solve/factorization.hpp"

#include <memory>
#include <mutex>

namespace elamin {

/// Held by the thread that uses MUMPS, or what uses it inside: the library keeps global state.
std::recursive_mutex& one_at_a_time();

/// LDLᵀ with 1×1 and 2×2 pivots (MUMPS): of indefinite matrices, with borders, with a reliable inertia (Sylvester's law). There is no factor
/// of what is singular to rounding. MUMPS serves one caller at a time; calls from several threads wait for each other.
class PivotedFactor final : public Factorization {
 public:
  PivotedFactor();
  ~PivotedFactor() override;

  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override;
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;

 private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
};

}  // namespace elamin
