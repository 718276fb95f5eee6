#pragma once
// The few types that everything else is written in.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <cstdint>
#include <limits>

namespace elamin {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vector = Eigen::VectorXd;                       // over the free dofs
using Field = Eigen::Matrix3Xd;                       // a vector for every particle, 3 × particles
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;  // symmetric: lower triangle only

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = 2.220446049250313e-16;     // spacing of the doubles at 1

}  // namespace elamin
