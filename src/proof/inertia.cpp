#include "proof/inertia.hpp"

#include "core/dense.hpp"
#include "proof/interval.hpp"
#include "solve/ordering.hpp"

#include <Eigen/OrderingMethods>

namespace elamin::proof {

void FillReducing::operator()(const SparseMatrix& full, Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order) const {
  const std::vector<int> found = fill_reducing_order(SparseMatrix(full.triangularView<Eigen::Lower>()));
  if (found.empty()) return Eigen::AMDOrdering<int>()(full, order);
  order.resize(full.cols());
  std::copy(found.begin(), found.end(), order.indices().data());
}

bool ShiftedFactor::factorize(const SparseMatrix& M, double shift) {
  factor_.setShift(-shift);
  factor_.factorize(M);
  const Vector D = factor_.vectorD();
  if (factor_.info() != Eigen::Success || !D.allFinite() || (D.array() == 0).any()) return false;
  negative_ = static_cast<int>((D.array() < 0).count());
  using I = Interval<double>;
  const SparseMatrix& L = factor_.matrixL().nestedExpression();           // its diagonal, which is 1, is not stored
  const int n = static_cast<int>(M.cols());
  std::vector<I> rows(n);                                                 // of |L||D||L|ᵀ 1
  std::vector<int> entries(n, 0);
  for (int j = 0; j < n; ++j) {
    I down(1);
    for (SparseMatrix::InnerIterator it(L, j); it; ++it) down += I(std::abs(it.value())), ++entries[it.row()];
    rows[j] += down *= I(std::abs(D[j]));
    for (SparseMatrix::InnerIterator it(L, j); it; ++it) rows[it.row()] += I(std::abs(it.value())) * down;
  }
  const double most = std::ranges::max(rows, {}, &I::hi).hi, diagonal = std::abs(shift) + infinity_norm(M.diagonal());
  const I u(0x1p-53), m(std::ranges::max(entries) + 4.0), gamma = m * u / (I(1) - m * u);
  error_ = (gamma * I(most) + I(0x1p-52) * I(diagonal) + I(1e-290)).hi;              // 1e-290: far above all underflows
  return error_ - error_ == 0;
}

Spectrum spectrum_near_zero(const SparseMatrix& M) {
  Spectrum s;
  ShiftedFactor factor(M);
  if (M.cols() == 0 || !factor.factorize(M, 0)) return s;
  s.negative = factor.negative();
  Vector v = Vector::NullaryExpr(M.cols(), [](Eigen::Index i) { return 1 + std::sin(1e4 * static_cast<double>(i)); }).normalized();
  for (int k = 0; k < 40; ++k) {                                          // inverse iteration
    v = factor.solve(v);
    s.estimate = 1 / v.norm(), v *= s.estimate;
  }
  if (!std::isfinite(s.estimate)) return s.estimate = 0, s;
  for (s.shift = 0.9 * s.estimate; s.shift > s.estimate / 20; s.shift /= 2) {
    s.error = 0;
    bool right = true;
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && s.negative == 0) continue;                          // below all of them
      right = right && factor.factorize(M, side * s.shift) && factor.negative() == s.negative;
      s.error = std::max(s.error, factor.error());
    }
    if (s.least = (Interval<double>(s.shift) - Interval<double>(s.error)).lo; right && s.least > 0) return s;
  }
  return s.least = 0, s;
}

}  // namespace elamin::proof
