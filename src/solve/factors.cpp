#include "solve/factors.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace elamin {

namespace {

// A block to start from: fixed, without symmetry, the same on every machine.
Eigen::MatrixXd starting_block(int rows, int columns) {
  Eigen::MatrixXd x(rows, columns);
  std::uint64_t s = 0x9E3779B97F4A7C15ull;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    s ^= s << 13, s ^= s >> 7, s ^= s << 17;                       // xorshift64 (Marsaglia 2003)
    x.data()[i] = static_cast<double>(s >> 11) / 9007199254740992.0 - 0.5;
  }
  return x;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& x) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(x).householderQ() * Eigen::MatrixXd::Identity(x.rows(), x.cols());
}

}  // namespace

Factors::Factors(Energy& energy) : energy_(energy) {}

PivotedFactor& Factors::pivoted() {
  if (!pivoted_) pivoted_ = std::make_unique<PivotedFactor>();
  return *pivoted_;
}

bool Factors::try_cholesky(double shift) {
  ++factorizations_;
  if (std::exchange(cholesky_version_, energy_.pattern_version()) != energy_.pattern_version()) cholesky_.analyze(energy_.hessian());
  return cholesky_.factorize(energy_.hessian(), shift);
}

bool Factors::try_pivoted(double shift) {
  ++factorizations_;
  if (std::exchange(pivoted_version_, energy_.pattern_version()) != energy_.pattern_version()) pivoted().analyze(energy_.hessian());
  return pivoted().factorize(energy_.hessian(), shift);
}

void Factors::factorize_holding(const Eigen::MatrixXd& held) {
  const double shift = held.cols() > 0 ? 100 * zero_level() : 0.0;
  definite_ = try_cholesky(shift);
  if (!definite_ && !try_pivoted(shift)) try_pivoted(shift + zero_level());
  held_.resize(energy_.dofs(), 0);
  response_.resize(energy_.dofs(), held.cols());
  for (Eigen::Index j = 0; j < held.cols(); ++j) response_.col(j) = solve_holding(held.col(j));
  held_ = held;
}

// μ from Zᵀ(H⁻¹b − H⁻¹Z μ) = 0; projected once more, as H⁻¹Z is large along Z.
Vector Factors::solve_holding(const Vector& b) {
  Vector p = definite_ ? cholesky_.solve(b) : pivoted().solve(b);
  for (int k = 0; k < 2 && held_.cols() > 0; ++k)
    p -= response_ * (held_.transpose() * response_).eval().partialPivLu().solve(held_.transpose() * p);
  return p;
}

double Factors::zero_level() const {
  const SparseMatrix& h = energy_.hessian();
  Vector sums = Vector::Zero(h.cols());
  for (int j = 0; j < h.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(h, j); it; ++it) {
      sums[j] += std::abs(it.value());
      if (it.row() != j) sums[it.row()] += std::abs(it.value());
    }
  return 16 * epsilon * (sums.size() ? sums.maxCoeff() : 0.0);
}

Inertia Factors::inertia() {
  const double sigma = zero_level();
  if (energy_.dofs() == 0 || try_cholesky(-sigma)) return {};
  Inertia inertia;
  if (!try_cholesky(sigma)) {
    try_pivoted(sigma);
    inertia.negative = pivoted().negative();
  }
  try_pivoted(-sigma);
  inertia.zero = std::max(0, pivoted().negative() - inertia.negative);
  return inertia;
}

double Factors::make_positive(double guess) {
  if (try_cholesky(0)) return 0;
  const double sigma = zero_level();
  if (try_cholesky(sigma)) return sigma;
  double shift = std::max(guess, 16 * sigma);
  while (!try_cholesky(shift)) {
    shift *= 32;
    if (!std::isfinite(shift)) throw std::runtime_error("the Hessian has entries that are not finite");
  }
  return shift;
}

EigenPairs Factors::lowest(int count, double guess, double accuracy, const Eigen::MatrixXd& start) {
  const int n = energy_.dofs();
  count = std::min(count, n);
  const int block = std::min(n, count + 4);
  if (count == 0) return {Vector(0), Eigen::MatrixXd(n, 0)};

  double shift = guess;
  if (!(guess > 0 && try_cholesky(guess))) shift = make_positive(guess);
  Eigen::MatrixXd x = starting_block(n, block);
  if (start.rows() == n) x.leftCols(std::min<Eigen::Index>(block, start.cols())) = start.leftCols(std::min<Eigen::Index>(block, start.cols()));
  Vector values = Vector::Zero(block), before;
  const int settle = 3, most = 200;
  for (int k = 0; k < most; ++k) {
    x = orthonormal(cholesky_.solve(x));
    Eigen::MatrixXd hx(n, block);
    for (int j = 0; j < block; ++j) hx.col(j) = energy_.multiply(x.col(j));
    const Eigen::MatrixXd projected = x.transpose() * hx;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small((projected + projected.transpose()) / 2);
    before = values;
    values = small.eigenvalues();
    x = x * small.eigenvectors();
    const double change = (values - before).head(count).cwiseAbs().maxCoeff();
    if (k >= settle && change <= accuracy * std::max(std::abs(values[0]), std::abs(values[count - 1])) + zero_level() / 64) break;
    if (k == settle && values[0] < 0 && shift > -4 * values[0]) {   // the first shift was a guess: come closer
      shift = -1.5 * values[0];
      while (!try_cholesky(shift)) shift *= 2;
    }
  }
  EigenPairs pairs{values.head(count), x.leftCols(count)};
  for (int j = 0; j < count; ++j) pairs.values[j] = energy_.quadratic_form(pairs.vectors.col(j));
  return pairs;
}

}  // namespace elamin
