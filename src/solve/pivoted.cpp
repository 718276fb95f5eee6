#include "solve/pivoted.hpp"

#include "core/timing.hpp"
#include "solve/bunch_kaufman.hpp"
#include "solve/limits.hpp"
#include "solve/mumps.hpp"

#include <cassert>

namespace elamin {

void PivotedFactor::analyze(const SparseMatrix& pattern, int borders) {
  const Timed timed(seconds_);
  if (pattern.rows() + borders <= limits::dense) factor_ = std::make_unique<BunchKaufman>();
  else factor_ = std::make_unique<Mumps>();
  factor_->analyze(pattern, borders);
}

bool PivotedFactor::factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) {
  assert(factor_);
  const Timed timed(seconds_);
  return factor_->factorize(hessian, shift, borders);
}

int PivotedFactor::negative() const { return factor_->negative(); }

Eigen::MatrixXd PivotedFactor::solve(const Eigen::MatrixXd& b) {
  if (b.size() == 0) return b;
  assert(factor_);
  const Timed timed(seconds_);
  return factor_->solve(b);
}

}  // namespace elamin
