#pragma once
#include "solve/factorization.hpp"

#include <memory>

namespace elamin {

/// LLᵀ by CHOLMOD, without borders; where supernodes pay their numbers come from `multifrontal`, on all cores; where ranks share their
/// factorisations, by them, and where there is not enough memory by MUMPS, on disk. There is a factor if and only if the matrix is positive definite to rounding; of an indefinite one it knows no more.
class Cholesky final : public Factorization {
 public:
  Cholesky();
  ~Cholesky() override;

  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override { return 0; }
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;
  Eigen::MatrixXd lowest(int count) override;
  bool iterates() const override { return instead_ && instead_->iterates(); }
  void set_near_null(const Eigen::MatrixXd& motions) override { instead_->set_near_null(motions); }
  /// Whether root() and root_transposed() can be asked for: the factor is in this process alone, in memory.
  bool has_root() const { return !instead_; }
  /// W b and Wᵀ b of a square root of the inverse, W Wᵀ = (H + shift·I)⁻¹: W = Qᵀ L⁻ᵀ, Q the ordering.
  Vector root(const Vector& b);
  Vector root_transposed(const Vector& b);

 private:
  struct Cholmod;
  Eigen::MatrixXd solve(int system, const Eigen::MatrixXd& b);
  std::unique_ptr<Cholmod> cholmod_;
  bool shared_;                                          // by ranks
  std::unique_ptr<Factorization> instead_;               // of CHOLMOD's
};

}  // namespace elamin
