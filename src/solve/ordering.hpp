#pragma once
// An order of the unknowns that keeps a Cholesky factor sparse, found on the graph of particles.
#include "core/types.hpp"

#include <vector>

namespace elamin {

/// The first of each set of adjacent unknowns that are coupled to each other and to the same others, and n: the coordinates of a particle.
/// `pattern`: lower triangle with full diagonal, rows in ascending order.
std::vector<int> coupled_alike(const SparseMatrix& pattern);

/// A permutation of the unknowns, by approximate minimum degree (Amestoy, Davis & Duff 1996, SIAM J. Matrix Anal. Appl. 17) or, where that
/// leaves many entries, by nested dissection (Karypis & Kumar 1998, SIAM J. Sci. Comput. 20; METIS) of the graph of those sets, whichever
/// leaves fewer. Empty where the sets are hardly fewer than the unknowns, or there is no memory.
std::vector<int> fill_reducing_order(const SparseMatrix& pattern);

/// What a Cholesky factor in that order takes: its entries that are not zero, and multiplications and additions to compute them, Σ c² of
/// columns with c entries. Supernodes keep 17 % more of them on sheets of 10⁵ particles (`build/release/tests/bench scale 300 1`).
struct FactorSize {
  double entries = 0, operations = 0;
  double bytes() const { return 8 * 1.17 * entries; }
};
FactorSize factor_size(const SparseMatrix& pattern);

}  // namespace elamin
