#pragma once
#include "solve/factorization.hpp"
#include "solve/multifrontal.hpp"

#include <optional>

namespace elamin {

/// LDLᵀ of indefinite matrices without borders, pivoted inside of supernodes alone, by `multifrontal`: faster than with pivots from
/// anywhere. There is no factor where that is not stable, or the matrix singular to rounding.
class BlockLdl final : public Factorization {
 public:
  void analyze(const SparseMatrix& pattern, int borders = 0) override;
  [[nodiscard]] bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) override;
  int negative() const override;
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;
  /// Whether it does at all: not for large fronts.
  bool suits() const { return fronts_.has_value(); }

 private:
  Supernodes pattern() const { return {super_, pi_, px_, rows_, permutation_}; }
  void divide_by_pivots(int s, Eigen::Ref<Eigen::MatrixXd> x) const;
  std::vector<int> super_, pi_, px_, rows_, permutation_;      // as in Supernodes
  std::optional<Multifrontal> fronts_;
  std::vector<double> l_;
  BlockPivots pivots_;
};

}  // namespace elamin
