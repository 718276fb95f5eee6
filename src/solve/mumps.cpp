#include "solve/mumps.hpp"

#include "core/heartbeat.hpp"
#include "solve/blas.hpp"

#include <dmumps_c.h>

#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace elamin {

namespace {

constexpr int fortran_communicator = -987654;              // MPI_COMM_WORLD of the sequential build
constexpr int first_room = 50, most_room = 1'000'000;      // % of memory for delayed pivots, ICNTL(14)

[[noreturn]] void mumps_failed(const std::string& what, int infog) {
  for (const int out_of_memory : {-5, -7, -13, -19})                            // of integers, reals, pointers
    if (infog == out_of_memory) throw OutOfMemory("there is not enough memory for a factor of the Hessian (MUMPS, " + what + ")");
  if (infog == -90) throw OutOfMemory("there is not enough room on disk for a factor of the Hessian, or it cannot be written (MUMPS, " + what + ")");
  throw std::runtime_error("MUMPS: the " + what + " failed, INFOG(1) = " + std::to_string(infog));
}

}  // namespace

std::recursive_mutex& one_at_a_time() {
  static std::recursive_mutex mutex;
  return mutex;
}

struct Mumps::Instance {
  explicit Instance(Kind of_kind) : kind(of_kind) {}
  Kind kind;
  DMUMPS_STRUC_C id{};
  std::vector<int> rows, columns;
  std::vector<double> values;
  bool started = false;

  int& icntl(int i) { return id.icntl[i - 1]; }
  void call(int job) {
    id.job = job;
    dmumps_c(&id);
  }
  void stop() {
    if (started) call(-2);
    started = false;
  }
};

Mumps::Mumps(Kind kind) : instance_(std::make_unique<Instance>(kind)) {}

Mumps::~Mumps() {
  const std::lock_guard lock(one_at_a_time());
  instance_->stop();
}

void Mumps::analyze(const SparseMatrix& pattern, int borders) {
  const std::lock_guard lock(one_at_a_time());
  Instance& m = *instance_;
  m.stop();
  m.rows.clear(), m.columns.clear();
  for (int j = 0; j < pattern.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(pattern, j); it; ++it)
      m.rows.push_back(static_cast<int>(it.row()) + 1), m.columns.push_back(j + 1);
  const int n = static_cast<int>(pattern.rows());
  for (int b = 0; b < borders; ++b)
    for (int j = 0; j <= n; ++j) m.rows.push_back(n + b + 1), m.columns.push_back(j < n ? j + 1 : n + b + 1);
  m.values.assign(m.rows.size(), 0.0);
  m.id = {};
  m.id.comm_fortran = fortran_communicator;
  m.id.par = 1, m.id.sym = m.kind == Kind::indefinite ? 2 : 1;
  m.call(-1);
  m.started = true;
  for (int i = 1; i <= 4; ++i) m.icntl(i) = i == 4 ? 0 : -1;   // silent
  m.icntl(13) = 1;                                         // no parallel root: its pivots would not be counted
  m.icntl(14) = first_room;
  m.icntl(10) = 0;                                         // Newton on exact residuals refines, not the solver
  if (m.kind == Kind::definite_on_disk) {
    m.icntl(22) = 1;
    if (!std::getenv("MUMPS_OOC_TMPDIR")) {
      const char* const folder = std::getenv("TMPDIR");
      std::snprintf(m.id.ooc_tmpdir, sizeof m.id.ooc_tmpdir, "%s", folder ? folder : "/var/tmp");
    }
  }
  m.id.n = n + borders;
  m.id.nnz = static_cast<std::int64_t>(m.rows.size());
  m.id.irn = m.rows.data(), m.id.jcn = m.columns.data(), m.id.a = m.values.data();
  const Doing doing("ordering the unknowns");
  m.call(1);
  if (m.id.infog[0] < 0) mumps_failed("analysis", m.id.infog[0]);
}

bool Mumps::factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) {
  const std::lock_guard lock(one_at_a_time());
  Instance& m = *instance_;
  const std::size_t entries = static_cast<std::size_t>(hessian.nonZeros());
  assert(entries <= m.values.size() && (borders.cols() == 0 || borders.rows() == hessian.rows()));    // analysed with as many borders
  for (std::size_t k = 0; k < entries; ++k) m.values[k] = hessian.valuePtr()[k] + (m.rows[k] == m.columns[k] ? shift : 0.0);
  const double scale = entries < m.values.size() ? border_scale(hessian, shift) : 0;
  for (std::size_t k = entries; k < m.values.size(); ++k) {
    const Eigen::Index i = m.columns[k] - 1, b = m.rows[k] - 1 - hessian.rows();
    m.values[k] = i < hessian.rows() ? scale * borders(i, b) : 0.0;
  }
  const Doing doing(m.kind == Kind::indefinite ? "factorising" : "factorising, on disk");
  for (m.call(2); (m.id.infog[0] == -8 || m.id.infog[0] == -9) && m.icntl(14) < most_room; m.call(2)) m.icntl(14) *= 3;   // delayed pivots need more
  if (m.id.infog[0] == -10 || m.id.infog[0] == -40) return false;         // numerically singular; not positive definite
  if (m.id.infog[0] < 0) mumps_failed("factorisation", m.id.infog[0]);
  return m.kind == Kind::indefinite || m.id.infog[11] == 0;
}

int Mumps::negative() const { return instance_->id.infog[11]; }

Eigen::MatrixXd Mumps::solve(const Eigen::MatrixXd& b) {
  if (b.size() == 0) return b;
  assert(b.rows() <= instance_->id.n);
  const std::lock_guard lock(one_at_a_time());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(instance_->id.n, b.cols());
  x.topRows(b.rows()) = b;
  instance_->id.rhs = x.data(), instance_->id.nrhs = static_cast<int>(x.cols()), instance_->id.lrhs = static_cast<int>(x.rows());
  instance_->call(3);
  if (instance_->id.infog[0] < 0) mumps_failed("solve", instance_->id.infog[0]);
  return x.topRows(b.rows());
}

}  // namespace elamin
