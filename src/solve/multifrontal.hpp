#pragma once
// The numbers of a supernodal factor, on all cores.
#include "core/types.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace elamin {

/// The pattern of a factor L of a permuted matrix of n rows, PHPᵀ = LLᵀ: sets of adjacent columns, the supernodes, that share their rows.
/// The columns of supernode s are super[s] … super[s+1] − 1, its rows, sorted, those columns first, rows[pi[s]] … rows[pi[s+1] − 1]; its
/// numbers stand from place px[s] on, column by column. Supernodes are in postorder. (This is how CHOLMOD keeps them.)
struct Supernodes {
  std::span<const int> super, pi, px, rows;
  std::span<const int> permutation;              // row i of PHPᵀ is row permutation[i] of H

  int count() const { return static_cast<int>(super.size()) - 1; }
  int columns(int s) const { return super[s + 1] - super[s]; }
  int height(int s) const { return pi[s + 1] - pi[s]; }
  /// Whether each front is small enough for one thread, as those of indefinite matrices must be.
  bool small_fronts() const;
};

/// The blocks of pivots of an indefinite matrix's factor, as LAPACK's dsytrf_rk leaves them.
struct BlockPivots {
  std::vector<int> order;                        // rows that are exchanged within a block; below zero: of a 2×2 pivot
  std::vector<double> beside;                    // entries of 2×2 pivots beside the diagonal
  std::vector<int> negative;                     // eigenvalues of each supernode's block
};

/// The inverse of a 2×2 pivot [d b; b e]:  by [g −1; −1 f],  f = d/b, g = e/b, by = 1/(b (f g − 1)),  which no product of entries is in.
struct PairInverse {
  double f, g, by;
  PairInverse(double d, double b, double e) : f(d / b), g(e / b), by(1 / (b * (f * g - 1))) {}
};

/// L by the multifrontal method (Duff & Reid 1983, ACM Trans. Math. Softw. 9): each supernode has a front, the dense matrix of its rows, to
/// which the entries of H and what is left of its children's fronts are added; its columns are factorised, and the rest goes to its parent.
/// Fronts of different branches of the tree are independent, large ones are cut into tiles that are. Everything is summed in an order that
/// is fixed by the pattern, so the bits of L are those of one thread for any number of them.
class Multifrontal {
 public:
  /// A part of a dense matrix, by columns.
  struct Block {
    double* at;
    int stride;
  };

  /// `pattern`: of the lower triangle of H. The arrays of `of` must outlive this.
  Multifrontal(const SparseMatrix& pattern, const Supernodes& of);
  /// Factorises H + shift·I into `l`, which has room for all supernodes. False if that is not positive definite to rounding, or if work is
  /// interrupted that takes more than a moment; `l` then means nothing. Throws OutOfMemory.
  [[nodiscard]] bool factorize(const SparseMatrix& h, double shift, double* l);
  /// The same of an indefinite matrix: LDLᵀ with a block of D for each supernode, pivoted inside (Bunch & Kaufman, bounded; LAPACK's dsytrf_rk),
  ///   A₁₁ = Pᵀ L₁₁ D L₁₁ᵀ P,   L₂₁ = A₂₁ Pᵀ L₁₁⁻ᵀ D⁻¹,   A₂₂ ← A₂₂ − L₂₁ D L₂₁ᵀ.
  /// False also if that is not stable: where what a supernode takes from a diagonal entry, Σ |L₂₁ D L₂₁ᵀ|, is more than `growth` of it, where it is all of it
  /// at most if H is positive definite; or a pivot is rounding.
  [[nodiscard]] bool factorize(const SparseMatrix& h, double shift, double* l, BlockPivots& pivots);
  /// Operations of a factorisation, ⅓ c³ + c² r + c r² of a supernode of c columns and r rows below them, multiplications and additions.
  double operations() const { return all_operations_; }

 private:
  struct Front;
  class Rest;
  void plan(const std::vector<int>& supernode);
  void place_entries(const SparseMatrix& pattern, const std::vector<int>& supernode);
  bool going();
  void work_on(int s);
  void assemble(const Front& front, int first, int last);
  void add_entries(const Front& front);
  void by_tiles(const Front& front);
  void whole(const Front& front);
  void eliminate_block(const Front& front);
  bool factorize_all(const SparseMatrix& h, double shift, double* l);
  void share_work();
  bool alone(int s) const;
  int panel(int s) const;
  Rest rest(int s) const;
  bool leaf(int s) const { return child_start_[s] == child_start_[s + 1]; }

  Supernodes of_;
  std::vector<int> parent_, first_;              // the first supernode of the subtree of each
  std::vector<int> child_start_, child_;
  std::vector<int> places_;                      // of the rows of a supernode below its columns in its parent's front; as rows
  std::vector<std::int64_t> entry_start_;        // of each supernode: entries of H
  std::vector<int> source_, target_;             // where they are in H and in the supernode's columns
  std::vector<double> operations_;               // of each subtree
  double all_operations_ = 0;
  std::vector<int> branches_;                    // roots of subtrees that one thread factorises

  // Of the factorisation under way.
  const double* values_ = nullptr;
  double shift_ = 0;
  double* l_ = nullptr;
  BlockPivots* pivots_ = nullptr;                // none: positive definite
  double largest_ = 0;                           // entry of H
  std::vector<double> diagonal_;                 // of PHPᵀ + shift·I, absolute
  std::vector<std::unique_ptr<double[]>> rest_;  // of the front of each supernode, see Rest
  std::unique_ptr<std::atomic<int>[]> waiting_;  // for so many children
  std::atomic<bool> failed_{false}, out_of_memory_{false};
  bool stoppable_ = false;
};

}  // namespace elamin
