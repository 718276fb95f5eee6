#include "solve/ordering.hpp"

#include <cholmod.h>

#include <algorithm>

namespace elamin {

namespace {

// CHOLMOD's own measures of an order that is good as it is: operations and entries of the factor, each of the entries of the matrix.
constexpr double few_operations = 500, few_entries = 5;

struct Order {
  std::vector<int> permutation;                  // none: there is no memory
  double entries = 0, operations = 0;
};

Order order_by(int method, cholmod_sparse& graph) {
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SIMPLICIAL;
  common.nmethods = 1, common.method[0].ordering = method;
  Order order;
  if (cholmod_factor* l = cholmod_analyze(&graph, &common)) {
    const int* first = static_cast<const int*>(l->Perm);
    order = {std::vector<int>(first, first + l->n), common.lnz, common.fl};
    cholmod_free_factor(&l, &common);
  }
  cholmod_finish(&common);
  return order;
}

}  // namespace

std::vector<int> coupled_alike(const SparseMatrix& pattern) {
  const int n = static_cast<int>(pattern.cols());
  const int *start = pattern.outerIndexPtr(), *row = pattern.innerIndexPtr();
  std::vector<int> rows(n, 0), with_next(n, 0);                 // columns left of i that have row i; that have row i + 1, too
  for (int j = 0; j < n; ++j)
    for (int k = start[j] + 1; k < start[j + 1]; ++k) {
      ++rows[row[k]];
      if (k + 1 < start[j + 1] && row[k + 1] == row[k] + 1) ++with_next[row[k]];
    }
  std::vector<int> first;
  for (int j = 0; j < n; ++j) {
    const int i = j - 1;
    const bool alike = j > 0 && start[j + 1] - start[j] == start[j] - start[i] - 1 && rows[j] == rows[i] + 1 && with_next[i] == rows[i] &&
                       std::equal(row + start[j], row + start[j + 1], row + start[i] + 1);
    if (!alike) first.push_back(j);
  }
  first.push_back(n);
  return first;
}

namespace {

// Of the sets of a pattern, the first of each and n in `first`.
Order order_of_sets(const SparseMatrix& pattern, const std::vector<int>& first) {
  const int sets = static_cast<int>(first.size()) - 1, n = static_cast<int>(pattern.cols());
  std::vector<int> set(n);
  for (int s = 0; s < sets; ++s) std::fill(set.begin() + first[s], set.begin() + first[s + 1], s);
  std::vector<int> start{0}, row;                               // of the graph: the first column of each set tells
  for (int s = 0; s < sets; ++s) {
    for (int k = pattern.outerIndexPtr()[first[s]]; k < pattern.outerIndexPtr()[first[s] + 1]; ++k)
      if (const int t = set[pattern.innerIndexPtr()[k]]; start.back() == static_cast<int>(row.size()) || row.back() != t) row.push_back(t);
    start.push_back(static_cast<int>(row.size()));
  }
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = sets, graph.nzmax = row.size(), graph.p = start.data(), graph.i = row.data();
  graph.stype = -1, graph.itype = CHOLMOD_INT, graph.xtype = CHOLMOD_PATTERN, graph.dtype = CHOLMOD_DOUBLE;
  graph.sorted = graph.packed = 1;
  Order best = order_by(CHOLMOD_AMD, graph);
  const double size = double(n) / sets;                         // of a set: so much more of the unknowns
  const bool good = size * best.operations < few_operations * best.entries || best.entries < few_entries * double(row.size());
  if (best.permutation.empty() || !good) {
    Order other = order_by(CHOLMOD_METIS, graph);
    if (!other.permutation.empty() && (best.permutation.empty() || other.entries < best.entries)) best = std::move(other);
  }
  return best;
}

}  // namespace

std::vector<int> fill_reducing_order(const SparseMatrix& pattern) {
  const std::vector<int> first = coupled_alike(pattern);
  const Eigen::Index sets = static_cast<Eigen::Index>(first.size()) - 1;
  std::vector<int> order;
  if (2 * sets > pattern.cols()) return order;
  order.reserve(pattern.cols());
  for (const int s : order_of_sets(pattern, first).permutation)
    for (int i = first[s]; i < first[s + 1]; ++i) order.push_back(i);
  return order;
}

FactorSize factor_size(const SparseMatrix& pattern) {
  const std::vector<int> first = coupled_alike(pattern);
  const double sets = static_cast<double>(first.size()) - 1, m = sets > 0 ? pattern.cols() / sets : 0;
  const Order order = sets > 0 ? order_of_sets(pattern, first) : Order{};
  // A set with k in its column is m columns of m k, m k − 1, … m k − m + 1 entries.
  return {m * m * order.entries - m * (m - 1) / 2 * sets,
          m * m * m * order.operations - m * m * (m - 1) * order.entries + m * (m - 1) * (2 * m - 1) / 6 * sets};
}

}  // namespace elamin
