#include "solve/factors.hpp"

#include "core/interrupt.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
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

Factors::Factors(Energy& energy) : energy_(energy) {
  const Model& model = energy.model();
  for (const Bond& b : model.bonds)
    for (const int p : b.particles)
      for (int c = 0; c < 3; ++c)
        if (energy.kinematics().dof(p, c) >= 0) stiffest_ = std::max(stiffest_, 2 * model.bond_types[b.type].stiffness);
}

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

// The pivoted factor of H + shift I, or with a shift a little larger where that is singular to rounding itself.
bool Factors::pivot_near(double first, double next) {
  return first_shift(first, next, 1.5, [&](double shift) { return try_pivoted(shift); }).has_value();
}

std::string Factors::why_none() const {
  const SparseMatrix& h = energy_.hessian();
  const Eigen::Map<const Vector> entries(h.valuePtr(), h.nonZeros());
  if (!entries.allFinite()) return "the Hessian has entries that are not finite: the energy has no second derivatives here";
  if (h.cols() > 0 && (entries.array() == 0).all()) return "the Hessian is zero: nothing here has a stiffness";
  if (interrupted()) return "interrupted";
  return "";
}

bool Factors::factorize_holding(const Eigen::MatrixXd& held) {
  if (held.cols() > 0) {
    ++factorizations_;
    if (!bordered_) bordered_ = std::make_unique<PivotedFactor>();
    if (bordered_version_ != energy_.pattern_version() || borders_ != held.cols()) {
      bordered_->analyze(energy_.hessian(), static_cast<int>(held.cols()));
      bordered_version_ = energy_.pattern_version(), borders_ = held.cols();
    }
    const auto done = first_shift(0, zero_level(), 2, [&](double shift) { return bordered_->factorize(energy_.hessian(), shift, held); });
    holder_ = done ? Holder::bordered : Holder::none;
  } else if (!indefinite_ && try_cholesky(0)) {
    holder_ = Holder::cholesky;
  } else {
    holder_ = pivot_near(0, zero_level()) ? Holder::pivoted : Holder::none;
  }
  return holder_ != Holder::none;
}

Vector Factors::solve_holding(const Vector& b) {
  switch (holder_) {
    case Holder::none: return Vector::Zero(b.size());
    case Holder::cholesky: return cholesky_.solve(b);
    case Holder::pivoted: return pivoted().solve(b);
    case Holder::bordered: break;
  }
  return bordered_->solve(b);
}

Factors::Bordered Factors::solve_bordered(const Vector& column, const Vector& row, double corner, const Vector& b, double beta) {
  const Vector left = solve_holding(row), right = solve_holding(column);
  const double left_pivot = corner - left.dot(column), right_pivot = corner - row.dot(right);
  const double first = (beta - left.dot(b)) / left_pivot;
  const Vector w = solve_holding(b - first * column);
  const double second = (beta - corner * first - row.dot(w)) / right_pivot;
  return {w - second * right, first + second};
}

double Factors::zero_level() const {
  const SparseMatrix& h = energy_.hessian();
  Vector sums = Vector::Zero(h.cols());
  for (int j = 0; j < h.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(h, j); it; ++it) {
      sums[j] += std::abs(it.value());
      if (it.row() != j) sums[it.row()] += std::abs(it.value());
    }
  return 16 * epsilon * std::max(stiffest_, sums.size() ? sums.maxCoeff() : 0.0);
}

Inertia Factors::inertia() {
  const double sigma = zero_level();
  if (energy_.dofs() == 0) return {};
  Inertia inertia;
  if (indefinite_ && try_pivoted(0)) {
    inertia.negative = pivoted().negative();
    holder_ = Holder::pivoted;
    if (inertia.negative > 0 && smallest() > 4 * sigma) return inertia;      // the factor stays for solutions
  }
  indefinite_ = false;
  holder_ = Holder::cholesky;
  if (try_cholesky(-sigma)) return {};
  holder_ = Holder::none;
  inertia.negative = 0;
  const Inertia unknown{0, energy_.dofs()};
  if (!try_cholesky(sigma)) {
    if (!pivot_near(sigma, 1.5 * sigma)) return unknown;
    inertia.negative = pivoted().negative();
  }
  if (!pivot_near(-sigma, -1.5 * sigma)) return unknown;
  holder_ = Holder::pivoted;
  inertia.zero = std::max(0, pivoted().negative() - inertia.negative);
  indefinite_ = inertia.negative > 0;
  return inertia;
}

// Of the eigenvalues' absolute values the least, by inverse iteration with the pivoted factor: good to a factor of two or so,
// and where one is zero to rounding, as small as that.
double Factors::smallest() {
  Vector x = starting_block(energy_.dofs(), 1).col(0).normalized();
  double estimate = 0;
  for (int k = 0; k < 3; ++k) {
    x = pivoted().solve(x);
    estimate = 1 / x.norm();
    x *= estimate;
  }
  return estimate;
}

std::optional<double> Factors::make_positive(double guess) {
  if (try_cholesky(0)) return 0;
  const double sigma = zero_level();
  return first_shift(sigma, std::max(guess, 16 * sigma), 32, [&](double shift) { return try_cholesky(shift); });
}

std::optional<double> Factors::make_positive_from(double shift, double growth) {
  const double first = std::max(shift, 0.0);
  return first_shift(first, first > 0 ? growth * first : zero_level(), growth, [&](double s) { return try_cholesky(s); });
}

EigenPairs Factors::nearest_zero(const Eigen::MatrixXd& start, const Eigen::MatrixXd& held) {
  constexpr int most = 12;
  const Eigen::Index block = start.cols();
  if (!factorize_holding(held)) return {Vector::Zero(block), start};
  Eigen::MatrixXd x = start, hx(start.rows(), block);
  Vector values = Vector::Zero(block);
  for (int k = 0; k < most && !interrupted(); ++k) {
    for (Eigen::Index j = 0; j < block; ++j) x.col(j) = solve_holding(x.col(j).normalized());
    x = orthonormal(x);
    for (Eigen::Index j = 0; j < block; ++j) hx.col(j) = energy_.multiply(x.col(j));
    const Eigen::MatrixXd projected = x.transpose() * hx;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small((projected + projected.transpose()) / 2);
    const Vector before = values;
    values = small.eigenvalues();
    x = x * small.eigenvectors();
    Eigen::Index least = 0;
    values.cwiseAbs().minCoeff(&least);
    if (k > 0 && std::abs(values[least] - before[least]) <= 1e-12 * std::abs(values[least]) + zero_level() / 256) break;
  }
  for (Eigen::Index j = 0; j < block; ++j) values[j] = energy_.quadratic_form(x.col(j));
  return {values, x};
}

EigenPairs Factors::lowest(int count, double guess, double accuracy, const Eigen::MatrixXd& start) {
  const int n = energy_.dofs();
  count = std::min(count, n);
  const int block = std::min(n, count + 4);
  if (count == 0) return {Vector(0), Eigen::MatrixXd(n, 0)};

  Eigen::MatrixXd x = starting_block(n, block);
  double shift = guess;
  if (!(guess > 0 && try_cholesky(guess))) {
    const std::optional<double> positive = make_positive(guess);
    if (!positive) return {Vector::Zero(count), orthonormal(x).leftCols(count)};
    shift = *positive;
  }
  if (start.rows() == n) x.leftCols(std::min<Eigen::Index>(block, start.cols())) = start.leftCols(std::min<Eigen::Index>(block, start.cols()));
  Vector values = Vector::Zero(block), before;
  const int settle = 3, most = 200;
  for (int k = 0; k < most && !interrupted(); ++k) {
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
      const std::optional<double> closer = make_positive_from(-1.5 * values[0]);
      if (!closer) break;
      shift = *closer;
    }
  }
  EigenPairs pairs{values.head(count), x.leftCols(count)};
  for (int j = 0; j < count; ++j) pairs.values[j] = energy_.quadratic_form(pairs.vectors.col(j));
  return pairs;
}

}  // namespace elamin
