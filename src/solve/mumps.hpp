#pragma once
#include "solve/factorization.hpp"

#include <memory>
#include <mutex>

namespace elamin {

/// Held by the thread that uses MUMPS, or what uses it inside: the library keeps global state.
std::recursive_mutex& one_at_a_time();

/// LDLᵀ with 1×1 and 2×2 pivots of sparse matrices, by MUMPS, which serves one caller at a time; calls from several threads wait for each other.
class Mumps final : public Factorization {
 public:
  /// definite: only of positive definite matrices, without pivoting, and in memory what is being eliminated alone; the rest in files under
  /// $MUMPS_OOC_TMPDIR, $TMPDIR or /var/tmp, which go with the factor.
  enum class Kind { indefinite, definite_on_disk };
  explicit Mumps(Kind kind = Kind::indefinite);
  ~Mumps() override;

  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override;
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;

 private:
  struct Instance;
  std::unique_ptr<Instance> instance_;
};

}  // namespace elamin
