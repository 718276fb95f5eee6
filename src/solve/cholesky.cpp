#include "solve/cholesky.hpp"

#include "core/heartbeat.hpp"
#include "core/timing.hpp"
#include "solve/blas.hpp"

#include <cholmod.h>
#include <omp.h>

#include <cassert>
#include <stdexcept>
#include <string>

namespace elamin {

namespace {

// A view, no copy.
cholmod_sparse view(const SparseMatrix& m) {
  cholmod_sparse a{};
  a.nrow = m.rows(), a.ncol = m.cols(), a.nzmax = m.nonZeros();
  a.p = const_cast<int*>(m.outerIndexPtr()), a.i = const_cast<int*>(m.innerIndexPtr());
  a.x = const_cast<double*>(m.valuePtr());
  a.stype = -1, a.itype = CHOLMOD_INT, a.xtype = CHOLMOD_REAL, a.dtype = CHOLMOD_DOUBLE, a.sorted = 1, a.packed = 1;
  return a;
}

[[noreturn]] void cholmod_failed(const std::string& what, int status) {
  if (status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE) throw OutOfMemory("there is not enough memory for a factor of the Hessian (CHOLMOD, " + what + ")");
  throw std::runtime_error("CHOLMOD: the " + what + " failed, status " + std::to_string(status));
}

// CHOLMOD opens teams of four threads for loops of a few hundred numbers, whatever it is told: none while this lives.
struct OneThread {
  int levels = omp_get_max_active_levels();
  OneThread() { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels); }
};

}  // namespace

struct Cholesky::Cholmod {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
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
    if (factor) cholmod_free_factor(&factor, &common);
    for (cholmod_dense** d : {&x, &y, &e})
      if (*d) cholmod_free_dense(d, &common);
  }
};

Cholesky::Cholesky() : cholmod_(std::make_unique<Cholmod>()) {}
Cholesky::~Cholesky() = default;

void Cholesky::analyze(const SparseMatrix& pattern, [[maybe_unused]] int borders) {
  assert(borders == 0);
  const Timed timed(seconds_);
  const OneThread one;
  cholmod_->release();
  if (pattern.cols() == 0) return;
  const Doing doing("ordering the unknowns");
  cholmod_sparse a = view(pattern);
  cholmod_->factor = cholmod_analyze(&a, &cholmod_->common);
  if (!cholmod_->factor) cholmod_failed("analysis", cholmod_->common.status);
}

bool Cholesky::factorize(const SparseMatrix& hessian, double shift, [[maybe_unused]] const Eigen::MatrixXd& borders) {
  assert(borders.cols() == 0);
  if (hessian.cols() == 0) return true;
  assert(cholmod_->factor && cholmod_->factor->n == static_cast<std::size_t>(hessian.cols()));    // analysed
  const Timed timed(seconds_);
  const OneThread one;
  const Doing doing("factorising");
  cholmod_sparse a = view(hessian);
  double beta[2] = {shift, 0};
  const int ok = cholmod_factorize_p(&a, beta, nullptr, 0, cholmod_->factor, &cholmod_->common);
  if (!ok && cholmod_->common.status < 0) cholmod_failed("factorisation", cholmod_->common.status);
  return cholmod_->common.status == CHOLMOD_OK && cholmod_->factor->minor == cholmod_->factor->n;
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

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) { return solve(CHOLMOD_A, b); }
Vector Cholesky::root(const Vector& b) { return solve(CHOLMOD_Pt, solve(CHOLMOD_Lt, b)).col(0); }
Vector Cholesky::root_transposed(const Vector& b) { return solve(CHOLMOD_L, solve(CHOLMOD_P, b)).col(0); }

}  // namespace elamin
