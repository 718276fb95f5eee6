#pragma once
// What a direct factorisation of sparse symmetric matrices does; CHOLMOD's is `cholesky`, of indefinite ones there is `pivoted`.
#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

/// s, the scale of the borders of H + τI: the least of the columns' largest entries, and at least √ε times the largest entry of all [force/length].
/// With larger borders no pivot of a soft column would be accepted, and the factor of a structure that bends much more easily than it stretches would
/// be dense; smaller ones would be lost in rounding.
inline double border_scale(const SparseMatrix& hessian, double shift) {
  Vector largest = Vector::Zero(hessian.cols());
  for (int j = 0; j < hessian.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(hessian, j); it; ++it) {
      const double size = std::abs(it.value() + (it.row() == j ? shift : 0.0));
      largest[j] = std::max(largest[j], size), largest[it.row()] = std::max(largest[it.row()], size);
    }
  if (largest.size() == 0) return 1;
  return std::max({largest.minCoeff(), std::sqrt(epsilon) * largest.maxCoeff(), std::numeric_limits<double>::min()});
}

/// A factorisation of H + τI or, with borders Z (n × m), of the matrix
///   [ H   sZ ]
///   [ sZᵀ  0 ] ,   s = border_scale(H, τ);
/// ordering and symbolic analysis once per pattern. H is given by its lower triangle with full diagonal.
class Factorization {
 public:
  Factorization() = default;
  virtual ~Factorization() = default;
  Factorization(const Factorization&) = delete;
  Factorization& operator=(const Factorization&) = delete;

  /// Takes the pattern, which must stay the same until the next call, and how many borders there will be.
  virtual void analyze(const SparseMatrix& pattern, int borders = 0) = 0;
  /// Factorises H + shift·I with the borders. False if there is no factor; negative() and solve() then mean nothing.  shift [force/length]
  [[nodiscard]] virtual bool factorize(const SparseMatrix& hessian, double shift = 0, const Eigen::MatrixXd& borders = {}) = 0;
  /// The number of negative eigenvalues of the matrix factorised last. With borders that are independent, m of them belong to
  /// the borders: the others are those of H among the vectors orthogonal to Z.
  virtual int negative() const = 0;
  /// (H + shift·I)⁻¹ b; with borders p of H p + Z μ = b, Zᵀ p = 0. Of b with rows for the borders, too: the solution of the bordered matrix.
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& b) = 0;
  Vector solve(const Vector& b) { return solve(Eigen::MatrixXd(b)).col(0); }
  /// Eigenvectors to the `count` lowest eigenvalues of the positive definite matrix factorised last, dofs × up to count, where the factorisation has
  /// a way of its own to them; they are near, not proven to be the lowest.
  virtual Eigen::MatrixXd lowest([[maybe_unused]] int count) { return {}; }
  /// Whether it solves by iterations, and wants to know before analyze of motions that cost next to nothing (dofs × any number), such as rigid ones.
  virtual bool iterates() const { return false; }
  virtual void set_near_null([[maybe_unused]] const Eigen::MatrixXd& motions) {}
  /// Time spent in all calls so far, waiting for other threads included.
  double seconds() const { return seconds_; }

 protected:
  double seconds_ = 0;
};

}  // namespace elamin
