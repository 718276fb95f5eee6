#include "solve/factors.hpp"

#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/sparse.hpp"
#include "model/rigid_motion.hpp"
#include "solve/limits.hpp"
#include "solve/ritz.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace elamin {

Factors::Factors(Energy& energy) : energy_(energy) {
  const Model& model = energy.model();
  for (const Bond& b : model.bonds)
    for (const int p : b.particles)
      for (int c = 0; c < 3; ++c)
        if (energy.kinematics().dof(p, c) >= 0) stiffest_ = std::max(stiffest_, 2 * model.bond_types[b.type].stiffness);
}

namespace {

// What is glued together, moved as one, as if nothing were supported: dofs × so many.
Eigen::MatrixXd rigid_motions(const Energy& energy) {
  Model free = energy.model();
  free.supports.clear();
  const Kinematics& kinematics = energy.kinematics();
  std::vector<Vector> motions;
  for (const RigidMotion& m : free_rigid_motions(free, energy.evaluated())) motions.push_back(kinematics.restrict(m.velocity_field(kinematics.sites())));
  Eigen::MatrixXd all(energy.dofs(), static_cast<Eigen::Index>(motions.size()));
  for (std::size_t j = 0; j < motions.size(); ++j) all.col(static_cast<Eigen::Index>(j)) = motions[j];
  return all;
}

}  // namespace

template <class F> bool Factors::attempt(Analysed<F>& in, double shift, const Eigen::MatrixXd& borders) {
  ++factorizations_;
  if (in.version != energy_.pattern_version() || in.borders != borders.cols()) {
    if (in.factor.iterates()) in.factor.set_near_null(rigid_motions(energy_));
    in.factor.analyze(energy_.hessian(), static_cast<int>(borders.cols()));
    in.version = energy_.pattern_version(), in.borders = borders.cols();
  }
  return in.factor.factorize(energy_.hessian(), shift, borders);
}
template bool Factors::attempt(Analysed<Cholesky>&, double, const Eigen::MatrixXd&);
template bool Factors::attempt(Analysed<PivotedFactor>&, double, const Eigen::MatrixXd&);

// The pivoted factor of H + shift I, or with a shift a little larger where that is singular to rounding itself.
bool Factors::pivot_near(double first, double next) {
  return first_shift(first, next, 1.5, [&](double shift) { return try_pivoted(shift); }).has_value();
}

std::string Factors::why_none() const {
  const SparseMatrix& h = energy_.hessian();
  const Eigen::Map<const Vector> entries(h.valuePtr(), h.nonZeros());
  if (!entries.allFinite()) return "the Hessian has entries that are not finite: the energy has no second derivatives here";
  if (h.cols() > 0 && zero_level() == 0) return "the Hessian is zero: nothing here has a stiffness";
  if (interrupted()) return "interrupted";
  return "";
}

bool Factors::pivot_beside(Analysed<PivotedFactor>& in, const Eigen::MatrixXd& held) {
  return first_shift(0, zero_level(), 2, [&](double shift) { return attempt(in, shift, held); }).has_value();
}

bool Factors::factorize_holding(const Eigen::MatrixXd& held) {
  assert(held.cols() == 0 || held.rows() == energy_.dofs());
  holder_ = nullptr, resolved_ = false, shift_ = 0;
  if (held.cols() > 0) {
    if (pivot_beside(bordered_, held)) holder_ = &bordered_.factor;
  } else if (!indefinite_ && try_cholesky(0)) {
    holder_ = &cholesky_.factor;
  } else if (pivot_near(0, zero_level())) {
    holder_ = &pivoted_.factor;
  }
  return holder_ != nullptr;
}

bool Factors::factorize_resolving(const Eigen::MatrixXd& held) {
  if (held.cols() > 0 || soft_.cols() == 0) return factorize_holding(held);
  const bool positive = !indefinite_ && try_cholesky(zero_level());
  resolved_ = resolve(soft_, positive).has_value(), shift_ = 0;
  return resolved_ || factorize_holding(held);
}

Vector Factors::gradient() const {
  Vector g = energy_.gradient();
  for (Eigen::Index j = 0; resolved_ && j < near_.x.cols(); ++j) {
    const BilinearForm slope = energy_.slope(near_.x.col(j));
    const double along = std::abs(slope.value) > limits::slope_rounding * epsilon * slope.size ? slope.value : 0;
    g += (along - near_.x.col(j).dot(g)) * near_.x.col(j);
  }
  return g;
}

Vector Factors::solve_holding(const Vector& b) {
  assert(b.size() == energy_.dofs());
  if (resolved_) return solve_resolved(b);
  if (shift_ != 0) return solve_shifted(b);
  return holder_ ? holder_->solve(b) : Vector(Vector::Zero(b.size()));
}

Factors::Bordered Factors::solve_bordered(const Vector& column, const Vector& row, double corner, const Vector& b, double beta) {
  assert(column.size() == energy_.dofs() && row.size() == energy_.dofs());
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
  add_absolute_row_sums(h, sums);
  return limits::rounding * epsilon * std::max(stiffest_, sums.size() ? sums.maxCoeff() : 0.0);
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
  assert(start.rows() == energy_.dofs() && start.cols() > 0);
  const Eigen::Index block = start.cols();
  const Doing doing("looking for eigenvalues");
  if (!factorize_holding(held)) return {Vector::Zero(block), start};
  Eigen::MatrixXd x = start;
  Vector values = Vector::Zero(block);
  for (int k = 0; k < limits::most_rounds && !interrupted(); ++k) {
    for (Eigen::Index j = 0; j < block; ++j) x.col(j) = solve_holding(x.col(j).normalized());
    x = orthonormal(x);
    const Vector before = values;
    values = rotate_to_ritz(energy_, x);
    Eigen::Index least = 0;
    values.cwiseAbs().minCoeff(&least);
    if (k + 1 >= limits::least_rounds && std::abs(values[least] - before[least]) <= 1e-12 * std::abs(values[least]) + zero_level() / 256) break;
  }
  for (Eigen::Index j = 0; j < block; ++j) values[j] = energy_.quadratic_form(x.col(j));
  return {values, x};
}

EigenPairs Factors::soft_pairs(Eigen::MatrixXd x, int rounds) {
  for (int k = 0; k < rounds; ++k) {
    for (Eigen::Index j = 0; j < x.cols(); ++j) x.col(j) = solve_holding(x.col(j).normalized());
    x = orthonormal(x);
    rotate_to_ritz(energy_, x);
  }
  Vector values(x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) values[j] = energy_.quadratic_form(x.col(j));
  return {values, x};
}

Vector Factors::soft_values(int count) {
  if (count == 0 || (!holder_ && !resolved_)) return {};
  Eigen::MatrixXd x = starting_block(energy_.dofs(), count);
  for (int twice = 0; twice < 2; ++twice) {
    x = orthonormal(x);
    if (!resolved_) x = holder_->solve(x);
    else for (int j = 0; j < count; ++j) x.col(j) = solve_resolved(x.col(j));
  }
  return singular_values(triangle(x)).values.cwiseInverse();
}

void Factors::refine(EigenPairs& pairs) {
  Eigen::MatrixXd& x = pairs.vectors;
  double before = infinity;
  for (int k = 0; k < limits::eigenvector_refinements; ++k) {
    Eigen::MatrixXd r(x.rows(), x.cols()), w(x.rows(), x.cols());
    for (Eigen::Index j = 0; j < x.cols(); ++j) r.col(j) = energy_.multiply(x.col(j));
    for (int twice = 0; twice < 2; ++twice) r -= x * (x.transpose() * r);
    for (Eigen::Index j = 0; j < x.cols(); ++j) w.col(j) = solve_holding(r.col(j));
    w -= x * (x.transpose() * w);
    const double second = (r.transpose() * w).diagonal().cwiseAbs().sum();
    if (!(second < before / 2)) break;
    before = second;
    x = orthonormal(x - w);
    rotate_to_ritz(energy_, x);
  }
  for (Eigen::Index j = 0; j < x.cols(); ++j) pairs.values[j] = energy_.quadratic_form(x.col(j));
}

// As many vectors, of the span of X, F⁻¹X, F⁻²X, …, F = H + σI, that are nearest to the eigenvectors of F's lowest eigenvalues: block Lanczos, each block
// orthogonal to all before it.  Source: Golub & Underwood 1977; Parlett, The Symmetric Eigenvalue Problem (1998), §13.
Eigen::MatrixXd Factors::krylov(const Eigen::MatrixXd& x) {
  const Eigen::Index n = x.rows(), m = x.cols(), most = std::min({limits::krylov_blocks, n / m, std::max<Eigen::Index>(2, limits::krylov_entries / (n * m))});
  Eigen::MatrixXd q(n, most * m), t = Eigen::MatrixXd::Zero(most * m, most * m), next = x;
  for (Eigen::Index k = 0;; k += m) {
    q.middleCols(k, m) = next;
    const auto all = q.leftCols(k + m);
    next = cholesky().solve(next);
    const Eigen::MatrixXd along = all.transpose() * next;
    t.block(0, k, k + m, m) = along, t.block(k, 0, m, k + m) = along.transpose();
    if (interrupted()) return x;
    if (k + m == q.cols()) break;
    next -= all * along;
    for (int twice = 0; twice < 2; ++twice) {
      next = orthonormal(next);
      next -= all * (all.transpose() * next);
    }
    next = orthonormal(next);
  }
  return q * symmetric_eigen(t).vectors.rightCols(m);
}

EigenPairs Factors::lowest(int count, double guess, double accuracy, const Eigen::MatrixXd& start) {
  const int n = energy_.dofs();
  assert(count >= 0 && (start.cols() == 0 || start.rows() == n));
  count = std::min(count, n);
  const int block = std::min(n, count + 4);
  if (count == 0) return {Vector(0), Eigen::MatrixXd(n, 0)};
  const Doing doing("looking for eigenvalues");

  Eigen::MatrixXd x = starting_block(n, block);
  double shift = guess;
  if (!(guess > 0 && try_cholesky(guess))) {
    const std::optional<double> positive = make_positive(guess);
    if (!positive) return {Vector::Zero(count), orthonormal(x).leftCols(count)};
    shift = *positive;
  }
  const Eigen::MatrixXd near = start.rows() == n ? start : cholesky().lowest(count);
  if (near.rows() == n) x.leftCols(std::min<Eigen::Index>(block, near.cols())) = near.leftCols(std::min<Eigen::Index>(block, near.cols()));
  Vector values = Vector::Zero(block), before;
  const int settle = 3, most = 200;
  for (int k = 0; k < most && !interrupted(); ++k) {
    x = orthonormal(cholesky().solve(x));
    before = values;
    values = rotate_to_ritz(energy_, x);
    const double change = (values - before).head(count).cwiseAbs().maxCoeff();
    const double floor = k < limits::patience ? 0.0 : zero_level() / 64;       // forms tell eigenvalues below that; motions that cost nothing have none
    if (k >= settle && change <= accuracy * std::max(std::abs(values[0]), std::abs(values[count - 1])) + floor) break;
    if (k == settle && -1.5 * values[0] > zero_level() && shift > -4 * values[0]) {   // the first shift was a guess: come closer, but no nearer than rounding
      const std::optional<double> closer = make_positive_from(-1.5 * values[0]);
      if (!closer) break;
      shift = *closer;
    }
    if (k % limits::krylov_rounds == 0 && k > settle) x = krylov(x);            // eigenvalues that lie close to each other part slowly
  }
  EigenPairs pairs{values.head(count), x.leftCols(count)};
  for (int j = 0; j < count; ++j) pairs.values[j] = energy_.quadratic_form(pairs.vectors.col(j));
  return pairs;
}

}  // namespace elamin
