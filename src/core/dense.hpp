#pragma once
// Linear algebra of small dense matrices: Eigen's decompositions, compiled once.
#include "core/types.hpp"

namespace elamin {

/// The largest |vᵢ|; 0 of an empty vector.
inline double infinity_norm(const Vector& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

/// Eigenvalues, ascending, and eigenvectors, orthonormal, in columns.
struct EigenPairs {
  Vector values;
  Eigen::MatrixXd vectors;
};

/// All eigenpairs of a symmetric matrix.
EigenPairs symmetric_eigen(const Eigen::MatrixXd& a);

/// Those of a symmetric tridiagonal matrix.
EigenPairs tridiagonal_eigen(const Vector& diagonal, const Vector& beside);

/// A = U diag(σ) Vᵀ, σ descending; U and V with as many columns as there are singular values.
struct Singular {
  Eigen::MatrixXd u;
  Vector values;
  Eigen::MatrixXd v;
};
Singular singular_values(const Eigen::MatrixXd& a);

/// An orthonormal basis of the columns' span (rows × columns, columns ≤ rows), the first k of it of the first k columns' span.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a);

/// An orthonormal basis of what is orthogonal to the columns, which are independent: rows × (rows − columns).
Eigen::MatrixXd complement(const Eigen::MatrixXd& a);

/// R of A = QR, upper triangular (columns × columns): RᵀR = AᵀA.
Eigen::MatrixXd triangle(const Eigen::MatrixXd& a);

/// The x of least ‖Ax − b‖.
Vector least_squares(const Eigen::MatrixXd& a, const Vector& b);

/// The X of AX = B, by Gaussian elimination with full pivoting; of a singular A one of those that solve what of B can be solved.
Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace elamin
