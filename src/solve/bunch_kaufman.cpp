#include "solve/bunch_kaufman.hpp"

#include <cassert>
#include <cmath>

extern "C" {
void dsytrf_rook_(const char* uplo, const int* n, double* a, const int* lda, int* ipiv, double* work, const int* lwork, int* info);
void dsytrs_rook_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda, const int* ipiv, double* b, const int* ldb, int* info);
}

namespace elamin {

namespace {

constexpr int widest_panel = 64;                           // of dsytrf_rook: columns that are factorised before the rest is updated

}  // namespace

void BunchKaufman::analyze(const SparseMatrix& pattern, int borders) {
  const Eigen::Index n = pattern.rows() + borders;
  matrix_.resize(n, n);
  pivots_.resize(static_cast<std::size_t>(n));
  work_.resize(static_cast<std::size_t>(n) * widest_panel);
}

bool BunchKaufman::factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) {
  const int n = static_cast<int>(matrix_.rows()), dofs = static_cast<int>(hessian.rows());
  assert(n - dofs == borders.cols());                      // analysed with as many borders
  matrix_.setZero();
  for (int j = 0; j < dofs; ++j)
    for (SparseMatrix::InnerIterator it(hessian, j); it; ++it) matrix_(it.row(), j) = it.value() + (it.row() == j ? shift : 0.0);
  if (n > dofs) matrix_.bottomLeftCorner(n - dofs, dofs) = border_scale(hessian, shift) * borders.transpose();
  const int room = static_cast<int>(work_.size());
  int info = 0;
  dsytrf_rook_("L", &n, matrix_.data(), &n, pivots_.data(), work_.data(), &room, &info);
  if (info != 0) return false;                             // a pivot is zero
  // Pivots in pairs are of 2×2 blocks, which are indefinite: a 1×1 pivot would have been taken elsewise.
  negative_ = 0;
  for (int k = 0; k < n; ++k) {
    if (pivots_[static_cast<std::size_t>(k)] < 0) ++negative_, ++k;
    else negative_ += matrix_(k, k) < 0;
  }
  return true;
}

Eigen::MatrixXd BunchKaufman::solve(const Eigen::MatrixXd& b) {
  const int n = static_cast<int>(matrix_.rows()), count = static_cast<int>(b.cols());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, count);
  x.topRows(b.rows()) = b;
  int info = 0;
  dsytrs_rook_("L", &n, &count, matrix_.data(), &n, pivots_.data(), x.data(), &n, &info);
  return x.topRows(b.rows());
}

}  // namespace elamin
