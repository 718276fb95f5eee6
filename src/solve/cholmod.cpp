#include "solve/cholmod.hpp"

#include "core/heartbeat.hpp"
#include "solve/blas.hpp"
#include "solve/ordering.hpp"

#include <span>
#include <stdexcept>
#include <vector>

namespace elamin {

namespace {

// Unknowns from which on the graph of particles is ordered, which takes half the time of the graph of unknowns; below, milliseconds.
constexpr Eigen::Index by_particles = 10'000;

std::span<const int> ints(const void* first, std::size_t count) { return {static_cast<const int*>(first), count}; }

}  // namespace

cholmod_sparse view(const SparseMatrix& m) {
  cholmod_sparse a{};
  a.nrow = m.rows(), a.ncol = m.cols(), a.nzmax = m.nonZeros();
  a.p = const_cast<int*>(m.outerIndexPtr()), a.i = const_cast<int*>(m.innerIndexPtr());
  a.x = const_cast<double*>(m.valuePtr());
  a.stype = -1, a.itype = CHOLMOD_INT, a.xtype = CHOLMOD_REAL, a.dtype = CHOLMOD_DOUBLE, a.sorted = 1, a.packed = 1;
  return a;
}

Supernodes supernodes(const cholmod_factor& l) {
  return {ints(l.super, l.nsuper + 1), ints(l.pi, l.nsuper + 1), ints(l.px, l.nsuper + 1), ints(l.s, l.ssize), ints(l.Perm, l.n)};
}

void cholmod_failed(const std::string& what, int status) {
  if (status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE) throw OutOfMemory("there is not enough memory for a factor of the Hessian (CHOLMOD, " + what + ")");
  throw std::runtime_error("CHOLMOD: the " + what + " failed, status " + std::to_string(status));
}

cholmod_factor* analysis_of(const SparseMatrix& pattern, cholmod_common& common) {
  const Doing doing("ordering the unknowns");
  cholmod_sparse a = view(pattern);
  std::vector<int> order = pattern.cols() >= by_particles ? fill_reducing_order(pattern) : std::vector<int>();
  common.nmethods = order.empty() ? 0 : 1, common.method[0].ordering = CHOLMOD_GIVEN;      // 0: its own choice
  cholmod_factor* const factor = cholmod_analyze_p(&a, order.empty() ? nullptr : order.data(), nullptr, 0, &common);
  // Of a pattern that is valid nothing else fails, by whatever status: CHOLMOD_INVALID, too, where an ordering got no memory.
  if (!factor) cholmod_failed("analysis", CHOLMOD_OUT_OF_MEMORY);
  return factor;
}

}  // namespace elamin
