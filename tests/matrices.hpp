#pragma once
// What tests ask of matrices.
#include "core/types.hpp"

namespace elamin {

inline double largest(const Field& f) { return f.cwiseAbs().maxCoeff(); }

/// Both triangles of a symmetric matrix that is kept as its lower one.
inline Eigen::MatrixXd whole(const SparseMatrix& lower) { return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>(); }

}  // namespace elamin
