#include "solve/cholesky.hpp"

#include "core/factor_counts.hpp"
#include "core/memory.hpp"
#include "core/heartbeat.hpp"
#include "core/timing.hpp"
#include "solve/blas.hpp"
#include "solve/cholmod.hpp"
#include "solve/mumps.hpp"
#include "solve/ranks.hpp"

#include <cassert>
#include <optional>

namespace elamin {

namespace {

constexpr double checked_from = 1e9;             // bytes that are looked for before they are asked for
constexpr double with_fronts = 1.1;                  // times the factor: with the fronts under way, as measured on sheets of 10⁵ and 3·10⁵ particles

}  // namespace

struct Cholesky::Cholmod {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  std::optional<Multifrontal> fronts;                          // of a supernodal factor, whose numbers they make
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;      // kept between solves: no allocation in the loop

  Cholmod() {
    ready_blas();
    cholmod_start(&common);
    common.print = 0;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
    common.supernodal = CHOLMOD_AUTO;
  }
  ~Cholmod() {
    release();
    cholmod_finish(&common);
  }
  void release() {
    fronts.reset();
    if (factor) cholmod_free_factor(&factor, &common);
    for (cholmod_dense** d : {&x, &y, &e})
      if (*d) cholmod_free_dense(d, &common);
  }

  bool by_columns(const SparseMatrix& hessian, double shift) {
    const OneThread one;
    cholmod_sparse a = view(hessian);
    double beta[2] = {shift, 0};
    const int ok = cholmod_factorize_p(&a, beta, nullptr, 0, factor, &common);
    if (!ok && common.status < 0) cholmod_failed("factorisation", common.status);
    return common.status == CHOLMOD_OK && factor->minor == factor->n;
  }
  // Whether its numbers, with the fronts under way, take more than the memory that is free. A system that grants more
  // memory than there is would end the program when they are written.
  bool lacks_room() const {
    if (!fronts || factor->xtype != CHOLMOD_PATTERN) return false;
    const double room = with_fronts * 8 * static_cast<double>(factor->xsize);
    return room >= checked_from && room > free_memory();
  }
  bool by_fronts(const SparseMatrix& hessian, double shift) {
    if (factor->xtype == CHOLMOD_PATTERN && !cholmod_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, factor, &common)) cholmod_failed("factorisation", common.status);
    return fronts->factorize(hessian, shift, static_cast<double*>(factor->x));
  }
};

Cholesky::Cholesky() : cholmod_(std::make_unique<Cholmod>()), instead_(shared_factorization(true)) { shared_ = instead_ != nullptr; }
Cholesky::~Cholesky() = default;

void Cholesky::analyze(const SparseMatrix& pattern, [[maybe_unused]] int borders) {
  assert(borders == 0);
  const Timed timed(seconds_);
  if (!shared_) instead_.reset();
  if (instead_) return instead_->analyze(pattern);
  const OneThread one;
  cholmod_->release();
  if (pattern.cols() == 0) return;
  cholmod_->factor = analysis_of(pattern, cholmod_->common);
  if (cholmod_->factor->is_super) cholmod_->fronts.emplace(pattern, supernodes(*cholmod_->factor));
}

bool Cholesky::factorize(const SparseMatrix& hessian, double shift, [[maybe_unused]] const Eigen::MatrixXd& borders) {
  assert(borders.cols() == 0);
  if (hessian.cols() == 0) return true;
  const Timed timed(seconds_);
  const Doing doing("factorising");
  if (!instead_ && cholmod_->lacks_room()) instead_ = std::make_unique<Mumps>(Mumps::Kind::definite_on_disk), instead_->analyze(hessian);
  if (instead_) return counted(instead_->factorize(hessian, shift));
  assert(cholmod_->factor && cholmod_->factor->n == static_cast<std::size_t>(hessian.cols()));    // analysed
  return counted(cholmod_->fronts ? cholmod_->by_fronts(hessian, shift) : cholmod_->by_columns(hessian, shift));
}

// One of CHOLMOD's systems with the factor: A x = b, or a part of it.
Eigen::MatrixXd Cholesky::solve(int system, const Eigen::MatrixXd& b) {
  if (b.rows() == 0) return b;
  assert(cholmod_->factor && cholmod_->factor->n == static_cast<std::size_t>(b.rows()));
  const Timed timed(seconds_);
  const OneThread one;
  cholmod_dense rhs{};
  rhs.nrow = b.rows(), rhs.ncol = b.cols(), rhs.nzmax = b.size(), rhs.d = b.rows();
  rhs.x = const_cast<double*>(b.data()), rhs.xtype = CHOLMOD_REAL, rhs.dtype = CHOLMOD_DOUBLE;
  Cholmod& c = *cholmod_;
  if (!cholmod_solve2(system, c.factor, &rhs, nullptr, &c.x, nullptr, &c.y, &c.e, &c.common))
    cholmod_failed("solve", c.common.status);
  return Eigen::Map<const Eigen::MatrixXd>(static_cast<double*>(c.x->x), b.rows(), b.cols());
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) {
  if (!instead_) return solve(CHOLMOD_A, b);
  const Timed timed(seconds_);
  return instead_->solve(b);
}

Eigen::MatrixXd Cholesky::lowest(int count) {
  const Timed timed(seconds_);
  return instead_ ? instead_->lowest(count) : Eigen::MatrixXd();
}

Vector Cholesky::root(const Vector& b) { return solve(CHOLMOD_Pt, solve(CHOLMOD_Lt, b)).col(0); }
Vector Cholesky::root_transposed(const Vector& b) { return solve(CHOLMOD_L, solve(CHOLMOD_P, b)).col(0); }

}  // namespace elamin
