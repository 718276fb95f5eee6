#pragma once
// Sums over sparse symmetric matrices.
#include "core/types.hpp"

#include <cmath>

namespace elamin {

/// Adds Σⱼ |hᵢⱼ| of a symmetric matrix, whose lower triangle is stored, to sums (rows).
inline void add_absolute_row_sums(const SparseMatrix& h, Vector& sums) {
  for (int j = 0; j < h.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(h, j); it; ++it) {
      sums[j] += std::abs(it.value());
      if (it.row() != j) sums[it.row()] += std::abs(it.value());
    }
}

}  // namespace elamin
