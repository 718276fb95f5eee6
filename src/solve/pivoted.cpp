#include "solve/pivoted.hpp"

#include "core/factor_counts.hpp"
#include "core/timing.hpp"
#include "solve/bunch_kaufman.hpp"
#include "solve/limits.hpp"
#include "solve/mumps.hpp"
#include "solve/ranks.hpp"

#include <cassert>

namespace elamin {

PivotedFactor::PivotedFactor(bool anywhere) : anywhere_(anywhere), shared_(shared_factorization(false)) {}

void PivotedFactor::analyze(const SparseMatrix& pattern, int borders) {
  const Timed timed(seconds_);
  if (shared_) return factor_ = shared_.get(), shared_->analyze(pattern, borders);
  by_blocks_ = !anywhere_ && borders == 0;
  if (by_blocks_) blocks_.analyze(pattern);
  any_.reset(), factor_ = nullptr;
}

bool PivotedFactor::factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) {
  const Timed timed(seconds_);
  if (shared_) return counted(shared_->factorize(hessian, shift, borders));
  factor_ = &blocks_;
  if (by_blocks_ && blocks_.suits() && counted(blocks_.factorize(hessian, shift, borders))) return true;
  if (!any_) {
    if (hessian.rows() + borders.cols() <= limits::dense) any_ = std::make_unique<BunchKaufman>();
    else any_ = std::make_unique<Mumps>();
    any_->analyze(hessian, static_cast<int>(borders.cols()));
  }
  factor_ = any_.get();
  return counted(factor_->factorize(hessian, shift, borders));
}

int PivotedFactor::negative() const { return factor_->negative(); }

Eigen::MatrixXd PivotedFactor::solve(const Eigen::MatrixXd& b) {
  if (b.size() == 0) return b;
  assert(factor_);
  const Timed timed(seconds_);
  return factor_->solve(b);
}

}  // namespace elamin
