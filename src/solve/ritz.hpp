#pragma once
// Blocks of vectors on their way to eigenvectors.
#include "core/dense.hpp"
#include "energy/energy.hpp"

namespace elamin {

/// Vectors to start from: fixed, without symmetry, the same on every machine.
Eigen::MatrixXd starting_block(int rows, int columns);

/// Turns the orthonormal columns of x within their span to the Ritz vectors of the Hessian; its Ritz values, ascending.
Vector rotate_to_ritz(const Energy& energy, Eigen::MatrixXd& x);

}  // namespace elamin
