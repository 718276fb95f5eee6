#include "solve/block_ldl.hpp"

#include "core/heartbeat.hpp"
#include "solve/blas.hpp"
#include "solve/cholmod.hpp"

#include <cassert>
#include <cstdint>
#include <numeric>
#include <span>

namespace elamin {

namespace {

constexpr Eigen::Index most_unknowns = 50'000;   // beyond, sheets have fronts that are too large, and MUMPS would have the analysis made twice

}  // namespace

void BlockLdl::analyze(const SparseMatrix& pattern, [[maybe_unused]] int borders) {
  assert(borders == 0);
  ready_blas();
  fronts_.reset();
  if (pattern.cols() == 0 || pattern.cols() > most_unknowns) return;
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0, common.supernodal = CHOLMOD_SUPERNODAL;
  const OneThread one;
  cholmod_factor* factor = analysis_of(pattern, common);
  const Supernodes of = supernodes(*factor);
  const bool small = of.small_fronts();
  const auto kept = [](std::span<const int> numbers) { return std::vector<int>(numbers.begin(), numbers.end()); };
  if (small) super_ = kept(of.super), pi_ = kept(of.pi), px_ = kept(of.px), rows_ = kept(of.rows), permutation_ = kept(of.permutation);
  const std::size_t numbers = factor->xsize;
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  if (!small) return;
  fronts_.emplace(pattern, this->pattern());
  l_.resize(numbers);
}

bool BlockLdl::factorize(const SparseMatrix& hessian, double shift, [[maybe_unused]] const Eigen::MatrixXd& borders) {
  assert(fronts_ && borders.cols() == 0 && hessian.cols() == super_.back());
  const Doing doing("factorising");
  return fronts_->factorize(hessian, shift, l_.data(), pivots_);
}

int BlockLdl::negative() const { return std::accumulate(pivots_.negative.begin(), pivots_.negative.end(), 0); }

// D⁻¹ x of a supernode's block.
void BlockLdl::divide_by_pivots(int s, Eigen::Ref<Eigen::MatrixXd> x) const {
  const double* const l = &l_[px_[s]];
  const int height = pi_[s + 1] - pi_[s];
  for (int k = 0; k < static_cast<int>(x.rows()); ++k) {
    const double d = l[std::int64_t(k) * (height + 1)];
    if (pivots_.order[super_[s] + k] < 0) {
      const PairInverse inverse(d, pivots_.beside[super_[s] + k], l[std::int64_t(k + 1) * (height + 1)]);
      for (Eigen::Index j = 0; j < x.cols(); ++j) {
        const double u = x(k, j), v = x(k + 1, j);
        x(k, j) = inverse.by * (inverse.g * u - v), x(k + 1, j) = inverse.by * (inverse.f * v - u);
      }
      ++k;
    } else {
      x.row(k) /= d;
    }
  }
}

Eigen::MatrixXd BlockLdl::solve(const Eigen::MatrixXd& b) {
  assert(b.rows() == super_.back());
  const Supernodes of = pattern();
  const int n = of.super.back(), count = static_cast<int>(b.cols());
  Eigen::MatrixXd x(n, b.cols()), part;
  for (int i = 0; i < n; ++i) x.row(i) = b.row(of.permutation[i]);
  const auto below = [&](int s) {
    const int c = of.columns(s), height = of.height(s);
    return Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(&l_[of.px[s]] + c, height - c, c, Eigen::OuterStride<>(height));
  };
  const auto divide = [&](int s, const char* transposed) {
    const double one = 1;
    const int c = of.columns(s), height = of.height(s);
    dtrsm_("L", "L", transposed, "U", &c, &count, &one, &l_[of.px[s]], &height, &x(of.super[s], 0), &n);
  };
  const auto exchange = [&](int s, int k) {
    if (const int other = std::abs(pivots_.order[of.super[s] + k]) - 1; other != k) x.row(of.super[s] + k).swap(x.row(of.super[s] + other));
  };
  for (int s = 0; s < of.count(); ++s) {
    const int c = of.columns(s), more = of.height(s) - c;
    const std::span<const int> rows = of.rows.subspan(of.pi[s] + c, more);
    for (int k = 0; k < c; ++k) exchange(s, k);
    divide(s, "N");
    if (more > 0) part.noalias() = below(s) * x.middleRows(of.super[s], c);
    for (int i = 0; i < more; ++i) x.row(rows[i]) -= part.row(i);
    divide_by_pivots(s, x.middleRows(of.super[s], c));
  }
  for (int s = of.count(); s-- > 0;) {
    const int c = of.columns(s), more = of.height(s) - c;
    const std::span<const int> rows = of.rows.subspan(of.pi[s] + c, more);
    part.resize(more, b.cols());
    for (int i = 0; i < more; ++i) part.row(i) = x.row(rows[i]);
    if (more > 0) x.middleRows(of.super[s], c).noalias() -= below(s).transpose() * part;
    divide(s, "T");
    for (int k = c; k-- > 0;) exchange(s, k);
  }
  Eigen::MatrixXd result(n, b.cols());
  for (int i = 0; i < n; ++i) result.row(of.permutation[i]) = x.row(i);
  return result;
}

}  // namespace elamin
