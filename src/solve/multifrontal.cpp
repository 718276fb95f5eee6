#include "solve/multifrontal.hpp"

#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "solve/blas.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*, double*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*, const double*, const int*,
            const double*, double*, const int*);
void dsytrf_rk_(const char*, const int*, double*, const int*, double*, int*, double*, const int*, int*);
}

namespace elamin {

namespace {

constexpr int tile = 256;                        // rows and columns of a tile
constexpr double shared_from = 5e7;              // operations that are worth more than one thread: some milliseconds
constexpr double branches = 64;                  // the largest subtree of one thread has such a part of all operations
constexpr int strip = 64;                        // columns of a symmetric product that are made at once; of a panel in dsytrf_rk
constexpr double growth = 8;                     // of diagonal entries, as much as a factor's rounding, limits::rounding, leaves room for
constexpr double long_work = 1e10;               // operations that nobody waits for who interrupts: a third of a second

using Block = Multifrontal::Block;

// The lower triangle of A = LLᵀ; false if A is not positive definite.
bool cholesky_of(Block a, int n) {
  int info = 0;
  dpotrf_("L", &n, a.at, &a.stride, &info);
  if (info != 0) return false;
  for (int j = 0; j < n; ++j)
    if (!(a.at[std::int64_t(j) * a.stride + j] > 0)) return false;            // not a number
  return true;
}

// B ← B L⁻ᵀ, B of `rows` rows and n columns.
void divide(Block l, int n, Block b, int rows) {
  const double one = 1;
  dtrsm_("R", "L", "T", "N", &rows, &n, &one, l.at, &l.stride, b.at, &b.stride);
}

// C ← beta C − A Bᵀ, C of n × m, A and B of k columns; of C = beta C − A Aᵀ the lower triangle alone.
void subtract_product(Block c, int n, int m, Block a, Block b, int k, double beta) {
  const double minus = -1;
  if (a.at == b.at) dsyrk_("L", "N", &n, &k, &minus, a.at, &a.stride, &beta, c.at, &c.stride);
  else dgemm_("N", "T", &n, &m, &k, &minus, a.at, &a.stride, b.at, &b.stride, &beta, c.at, &c.stride);
}

}  // namespace

// What is left of a front: of n rows on both sides the lower triangle, in panels of so many columns, each from its first row on.
class Multifrontal::Rest {
 public:
  Rest(int n, int panel, double* at) : n_(n), panel_(panel), at_(at) {}
  static std::size_t size(int n, int panel) {
    std::size_t all = 0;
    for (int j = 0; j < n; j += panel) all += std::size_t(n - j) * std::min(panel, n - j);
    return all;
  }
  /// Its row i is column(j)[i], from the panel's first row on.
  double* column(int j) const {
    const std::int64_t p = j / panel_, first = p * panel_, stride = n_ - first;
    return at_ + p * panel_ * n_ - panel_ * std::int64_t(panel_) * (p * (p - 1) / 2) + (j - first) * stride - first;
  }
  /// From an entry on, in the panel of its column.
  Block from(int i, int j) const { return {column(j) + i, n_ - j / panel_ * panel_}; }

 private:
  int n_, panel_;
  double* at_;
};

// The dense matrix of a supernode: its columns, which stand in L, and the rest, of the rows below.
struct Multifrontal::Front {
  int s, columns, height;
  Block left;
  Rest rest;
  int below() const { return height - columns; }
};

Multifrontal::Multifrontal(const SparseMatrix& pattern, const Supernodes& of) : of_(of) {
  std::vector<int> supernode(of.super.back());                                // of each column
  for (int s = 0; s < of.count(); ++s) std::fill(supernode.begin() + of.super[s], supernode.begin() + of.super[s + 1], s);
  plan(supernode);
  place_entries(pattern, supernode);
}

// The tree, and which parts of it are for one thread.
void Multifrontal::plan(const std::vector<int>& supernode) {
  const int count = of_.count();
  parent_.assign(count, -1), first_.resize(count), operations_.assign(count, 0);
  child_start_.assign(count + 1, 0);
  for (int s = 0; s < count; ++s) first_[s] = s;
  for (int s = 0; s < count; ++s) {
    const double c = of_.columns(s), r = of_.height(s) - c;
    operations_[s] += c * c * c / 3 + c * c * r + c * r * r;
    if (r == 0) {
      all_operations_ += operations_[s];
      continue;
    }
    const int p = parent_[s] = supernode[of_.rows[of_.pi[s] + of_.columns(s)]];
    operations_[p] += operations_[s];
    assert(p > s && (first_[p] == p || parent_[first_[s] - 1] == p));        // in postorder
    first_[p] = std::min(first_[p], first_[s]);
    ++child_start_[p + 1];
  }
  for (int s = 0; s < count; ++s) child_start_[s + 1] += child_start_[s];
  child_.resize(child_start_[count]);
  std::vector<int> next(child_start_.begin(), child_start_.end() - 1);
  for (int s = 0; s < count; ++s)
    if (parent_[s] >= 0) child_[next[parent_[s]]++] = s;
  for (int s = 0; s < count; ++s)                               // the largest for one thread, and leaves that are too large for that
    if (alone(s) ? parent_[s] < 0 || !alone(parent_[s]) : leaf(s)) branches_.push_back(s);

  places_.resize(of_.rows.size());
  parallel_for(count, 1000, [&](std::int64_t s) {
    const int p = parent_[s];
    if (p < 0) return;
    const int* row = &of_.rows[of_.pi[p]];
    int at = 0;
    for (int i = of_.pi[s] + of_.columns(static_cast<int>(s)); i < of_.pi[s + 1]; ++i) {
      while (row[at] < of_.rows[i]) ++at;
      places_[i] = at;
    }
  });
  rest_.resize(count);
  waiting_ = std::make_unique<std::atomic<int>[]>(count);
}

// Large fronts are cut into tiles.
int Multifrontal::panel(int s) const { return of_.height(s) > 2 * tile ? tile : std::max(1, of_.height(s) - of_.columns(s)); }

Multifrontal::Rest Multifrontal::rest(int s) const { return {of_.height(s) - of_.columns(s), panel(s), rest_[s].get()}; }

bool Multifrontal::alone(int s) const { return operations_[s] <= all_operations_ / branches; }

void Multifrontal::place_entries(const SparseMatrix& pattern, const std::vector<int>& supernode) {
  const int count = of_.count(), n = of_.super.back();
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[of_.permutation[i]] = i;
  const int *start = pattern.outerIndexPtr(), *row = pattern.innerIndexPtr();
  entry_start_.assign(count + 1, 0);
  for (int j = 0; j < n; ++j)
    for (int k = start[j]; k < start[j + 1]; ++k) ++entry_start_[supernode[std::min(place[row[k]], place[j])] + 1];
  for (int s = 0; s < count; ++s) entry_start_[s + 1] += entry_start_[s];
  source_.resize(pattern.nonZeros()), target_.resize(pattern.nonZeros());
  std::vector<std::int64_t> next(entry_start_.begin(), entry_start_.end() - 1);
  for (int j = 0; j < n; ++j)
    for (int k = start[j]; k < start[j + 1]; ++k) {
      const std::int64_t at = next[supernode[std::min(place[row[k]], place[j])]]++;
      source_[at] = k, target_[at] = place[j];
    }
  parallel_for(count, 1000, [&](std::int64_t i) {
    const int s = static_cast<int>(i), first = of_.super[s];
    thread_local std::vector<int> position;
    if (position.size() < std::size_t(n)) position.resize(n);
    for (int r = 0; r < of_.height(s); ++r) position[of_.rows[of_.pi[s] + r]] = r;
    for (std::int64_t k = entry_start_[s]; k < entry_start_[s + 1]; ++k) {
      const auto [c, r] = std::minmax(place[row[source_[k]]], target_[k]);
      target_[k] = (c - first) * of_.height(s) + position[r];
    }
  });
}

// Columns first … last − 1 of a front before its factorisation: entries of H, then the children one after the other.
void Multifrontal::assemble(const Front& front, int first, int last) {
  const auto column = [&](int j) {                                            // its row i is column(j)[i]
    if (j < front.columns) return front.left.at + std::int64_t(j) * front.left.stride;
    return front.rest.column(j - front.columns) - front.columns;
  };
  const int used = leaf(front.s) ? front.columns : front.height;              // where there is nothing to add to, products are put
  for (int j = first; j < std::min(last, used); ++j) std::fill(column(j) + j, column(j) + front.height, 0.0);
  struct Run { int from, to, length; };
  thread_local std::vector<Run> runs;                                         // rows of a child that are adjacent in both
  for (int c = child_start_[front.s]; c < child_start_[front.s + 1]; ++c) {
    const int child = child_[c], size = of_.height(child) - of_.columns(child);
    const int* to = &places_[of_.pi[child] + of_.columns(child)];
    const auto first_at = [&](int row) { return static_cast<int>(std::lower_bound(to, to + size, row) - to); };
    const int begin = first_at(first), end = first_at(last);
    if (begin == end) continue;
    const Rest rest_of_child = rest(child);
    runs.clear();
    for (int i = begin; i < size; ++i)
      if (i > begin && to[i] == to[i - 1] + 1) ++runs.back().length;
      else runs.push_back({i, to[i], 1});
    std::size_t r = 0;
    for (int j = begin; j < end; ++j) {
      const double* const from = rest_of_child.column(j);
      double* const into = column(to[j]);
      while (runs[r].from + runs[r].length <= j) ++r;
      const int skipped = j - runs[r].from;
      for (std::size_t q = r; q < runs.size(); ++q) {
        const int skip = q == r ? skipped : 0;
        const double* const a = from + runs[q].from;
        double* const b = into + runs[q].to;
        for (int i = skip; i < runs[q].length; ++i) b[i] += a[i];
      }
    }
  }
}

void Multifrontal::add_entries(const Front& front) {
  for (std::int64_t k = entry_start_[front.s]; k < entry_start_[front.s + 1]; ++k) front.left.at[target_[k]] += values_[source_[k]];
  for (int j = 0; j < front.columns; ++j) front.left.at[std::int64_t(j) * (front.height + 1)] += shift_;
}

// A large front. Tiles are cut at multiples of `tile` from the first column and from the first row below.
void Multifrontal::by_tiles(const Front& front) {
  std::vector<int> cut;
  for (int i = 0; i < front.columns; i += tile) cut.push_back(i);
  const int left = static_cast<int>(cut.size());
  for (int i = front.columns; i < front.height; i += tile) cut.push_back(i);
  const int all = static_cast<int>(cut.size());
  cut.push_back(front.height);
  const auto rows = [&](int i) { return cut[i + 1] - cut[i]; };
  const auto at = [&](int i, int j) { return Block{front.left.at + std::int64_t(cut[j]) * front.left.stride + cut[i], front.left.stride}; };
  const auto rest_at = [&](int i, int j) { return front.rest.from(cut[i] - front.columns, cut[j] - front.columns); };
  for (int j = 0; j < all; ++j)
#pragma omp task default(shared) firstprivate(j)
    assemble(front, cut[j], cut[j + 1]);
#pragma omp taskwait
  add_entries(front);
  std::vector<char> tiles(std::size_t(all) * left);                           // their addresses stand for them
  [[maybe_unused]] char* const mark = tiles.data();
  for (int k = 0; k < left; ++k) {
#pragma omp task default(shared) firstprivate(k) depend(inout : mark[k * all + k])
    if (going() && !cholesky_of(at(k, k), rows(k))) failed_ = true;
    for (int i = k + 1; i < all; ++i)
#pragma omp task default(shared) firstprivate(i, k) depend(in : mark[k * all + k]) depend(inout : mark[k * all + i])
      if (going()) divide(at(k, k), rows(k), at(i, k), rows(i));
    for (int j = k + 1; j < left; ++j)
      for (int i = j; i < all; ++i)
#pragma omp task default(shared) firstprivate(i, j, k) depend(in : mark[k * all + i], mark[k * all + j]) depend(inout : mark[j * all + i])
        if (going()) subtract_product(at(i, j), rows(i), rows(j), at(i, k), at(j, k), rows(k), 1);
  }
  const int last = left - 1;
  for (int j = left; j < all; ++j)
    for (int i = j; i < all; ++i)
#pragma omp task default(shared) firstprivate(i, j) depend(in : mark[last * all + i], mark[last * all + j])
      if (going()) subtract_product(rest_at(i, j), rows(i), rows(j), at(i, 0), at(j, 0), front.columns, leaf(front.s) ? 0 : 1);
#pragma omp taskwait
}

void Multifrontal::whole(const Front& front) {
  assemble(front, 0, front.height);
  add_entries(front);
  if (pivots_) return eliminate_block(front);
  if (!cholesky_of(front.left, front.columns)) failed_ = true;
  if (front.below() == 0 || failed_) return;
  const Block under{front.left.at + front.columns, front.height};
  divide(front.left, front.columns, under, front.below());
  subtract_product(front.rest.from(0, 0), front.below(), front.below(), under, under, front.columns, leaf(front.s) ? 0 : 1);
}

void Multifrontal::eliminate_block(const Front& front) {
  const int c = front.columns, below = front.below();
  int* const order = &pivots_->order[of_.super[front.s]];
  double* const beside = &pivots_->beside[of_.super[front.s]];
  thread_local std::vector<double> work;
  thread_local std::vector<int> place;
  thread_local Vector taken;                                                  // Σ |L₂₁ D L₂₁ᵀ| of diagonal entries
  const std::size_t room = std::size_t(std::max(strip, below)) * c;
  if (work.size() < room) work.resize(room);
  const int panel = strip * c;
  int info = 0;
  dsytrf_rk_("L", &c, front.left.at, &front.height, beside, order, work.data(), &panel, &info);
  const auto diagonal = [&](int k) { return front.left.at[std::int64_t(k) * (front.height + 1)]; };
  int negative = 0;
  double least = infinity;
  for (int k = 0; k < c; ++k) {
    if (order[k] < 0) {                                        // 2×2, with eigenvalues of either sign
      const double d = diagonal(k), e = diagonal(k + 1), b = beside[k];
      least = std::min(least, std::abs(b * b - d * e) / std::max({std::abs(d), std::abs(e), std::abs(b)}));
      ++negative, ++k;
    } else {
      least = std::min(least, std::abs(diagonal(k)));
      negative += diagonal(k) < 0;
    }
  }
  pivots_->negative[front.s] = negative;
  if (info != 0 || !(least > growth * epsilon * largest_)) failed_ = true;
  if (below == 0 || failed_) return;
  // Y = A₂₁ Pᵀ L⁻ᵀ and L₂₁ = Y D⁻¹, with A₁₁ = Pᵀ L D Lᵀ P.
  place.resize(c);
  std::iota(place.begin(), place.end(), 0);
  for (int k = 0; k < c; ++k) std::swap(place[k], place[std::abs(order[k]) - 1]);
  const auto under = [&](int k) { return front.left.at + std::int64_t(k) * front.height + c; };
  const Block y{work.data(), below};
  for (int k = 0; k < c; ++k) std::copy(under(place[k]), under(place[k]) + below, y.at + std::int64_t(k) * below);
  const double one = 1, minus = -1, beta = leaf(front.s) ? 0 : 1;
  dtrsm_("R", "L", "T", "U", &below, &c, &one, front.left.at, &front.height, y.at, &below);
  taken.setZero(below);
  for (int k = 0; k < c; ++k) {
    const double *const at = y.at + std::int64_t(k) * below, *const next = at + below;
    if (order[k] < 0) {
      const PairInverse inverse(diagonal(k), beside[k], diagonal(k + 1));
      double *const to = under(k), *const beyond = under(k + 1);
      for (int i = 0; i < below; ++i) {
        to[i] = inverse.by * (inverse.g * at[i] - next[i]), beyond[i] = inverse.by * (inverse.f * next[i] - at[i]);
        taken[i] += std::abs(to[i] * at[i]) + std::abs(beyond[i] * next[i]);
      }
      ++k;
    } else {
      const double by = 1 / diagonal(k);
      double* const to = under(k);
      for (int i = 0; i < below; ++i) to[i] = by * at[i], taken[i] += std::abs(to[i] * at[i]);
    }
  }
  const std::span<const int> row = of_.rows.subspan(of_.pi[front.s] + c, below);
  for (int i = 0; i < below; ++i)
    if (!(taken[i] <= growth * diagonal_[row[i]])) failed_ = true;            // not a number, either
  if (failed_) return;
  for (int j = 0; j < below; j += strip) {
    const int rows = below - j, columns = std::min(strip, rows);
    dgemm_("N", "T", &rows, &columns, &c, &minus, front.left.at + c + j, &front.height, y.at + j, &below, &beta,
           front.rest.from(j, j).at, &below);
  }
}

// Whether there is any use in going on.
bool Multifrontal::going() {
  if (!failed_ && stoppable_ && interrupted()) failed_ = gave_up = true;
  return !failed_;
}

void Multifrontal::work_on(int s) {
  if (!going()) return;
  if (const int below = of_.height(s) - of_.columns(s); below > 0) {
    rest_[s].reset(new (std::nothrow) double[Rest::size(below, panel(s))]);
    if (!rest_[s]) {
      out_of_memory_ = failed_ = true;
      return;
    }
  }
  const Front front{s, of_.columns(s), of_.height(s), {l_ + of_.px[s], of_.height(s)}, rest(s)};
  if (front.height > 2 * tile) by_tiles(front);
  else whole(front);
  for (int c = child_start_[s]; c < child_start_[s + 1]; ++c) rest_[child_[c]].reset();
}

// All supernodes on all cores: each after its children, by a thread that then goes on with those above as far as it was the last of what
// they waited for. Begun with the branches, whose supernodes one thread takes one after the other.
void Multifrontal::share_work() {
  for (int s = 0; s < of_.count(); ++s) waiting_[s] = child_start_[s + 1] - child_start_[s];
#pragma omp parallel
  {
    try {
      ready_blas();
    } catch (const OutOfMemory&) {
      out_of_memory_ = failed_ = true;
    }
#pragma omp barrier
#pragma omp master
    for (const int root : branches_)
#pragma omp task firstprivate(root)
    {
      int s = alone(root) ? first_[root] : root;
      for (; s < root; ++s) work_on(s);
      do work_on(s);
      while ((s = parent_[s]) >= 0 && waiting_[s].fetch_sub(1, std::memory_order_acq_rel) == 1);
    }
  }
}

bool Supernodes::small_fronts() const {
  for (int s = 0; s < count(); ++s)
    if (height(s) > 2 * tile) return false;
  return true;
}

bool Multifrontal::factorize(const SparseMatrix& h, double shift, double* l) {
  pivots_ = nullptr;
  return factorize_all(h, shift, l);
}

bool Multifrontal::factorize(const SparseMatrix& h, double shift, double* l, BlockPivots& pivots) {
  assert(of_.small_fronts());
  const int n = of_.super.back();
  pivots.order.resize(n), pivots.beside.resize(n), pivots.negative.resize(of_.count());
  pivots_ = &pivots;
  largest_ = std::max(Eigen::Map<const Vector>(h.valuePtr(), h.nonZeros()).cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  diagonal_.resize(n);
  for (int i = 0; i < n; ++i) diagonal_[i] = std::abs(h.valuePtr()[h.outerIndexPtr()[of_.permutation[i]]] + shift);
  return factorize_all(h, shift, l);
}

bool Multifrontal::factorize_all(const SparseMatrix& h, double shift, double* l) {
  values_ = h.valuePtr(), shift_ = shift, l_ = l;
  failed_ = out_of_memory_ = false;
  stoppable_ = all_operations_ > long_work;
  if (all_operations_ >= shared_from && omp_get_max_threads() > 1 && !omp_in_parallel()) share_work();
  else
    for (int s = 0; s < of_.count() && !failed_; ++s) work_on(s);
  if (failed_)
    for (auto& rest : rest_) rest.reset();
  if (out_of_memory_) throw OutOfMemory("there is not enough memory for a factor of the Hessian");
  return !failed_;
}

}  // namespace elamin
