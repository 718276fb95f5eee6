#include "core/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <cassert>
#include <utility>

namespace elamin {

EigenPairs symmetric_eigen(const Eigen::MatrixXd& a) {
  assert(a.rows() == a.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

EigenPairs tridiagonal_eigen(const Vector& diagonal, const Vector& beside) {
  assert(beside.size() + 1 == diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// A = Q R Pᵀ first, then those of R. JacobiSVD of Eigen 3.4 would do the same, but destroys its Q R twice where there is no memory for it.
Singular singular_values(const Eigen::MatrixXd& a) {
  if (a.rows() < a.cols()) {
    Singular of_transpose = singular_values(a.transpose());
    return {std::move(of_transpose.v), std::move(of_transpose.values), std::move(of_transpose.u)};
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::MatrixXd r = qr.matrixR().topRows(a.cols()).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(a.rows(), a.cols());
  u.topRows(a.cols()) = svd.matrixU();
  u.applyOnTheLeft(qr.householderQ());
  return {std::move(u), svd.singularValues(), qr.colsPermutation() * svd.matrixV()};
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a) {
  assert(a.cols() <= a.rows());
  return Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
}

Eigen::MatrixXd complement(const Eigen::MatrixXd& a) {
  assert(a.cols() <= a.rows());
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ();
  return q.rightCols(a.rows() - a.cols());
}

Eigen::MatrixXd triangle(const Eigen::MatrixXd& a) {
  assert(a.cols() <= a.rows());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

Vector least_squares(const Eigen::MatrixXd& a, const Vector& b) {
  assert(a.rows() == b.size());
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a).solve(b);
}

Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  assert(a.rows() == a.cols() && a.rows() == b.rows());
  return Eigen::FullPivLU<Eigen::MatrixXd>(a).solve(b);
}

}  // namespace elamin
