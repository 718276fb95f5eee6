#pragma once
// From derivatives by the places of what bodies carry to derivatives by the poses of the bodies.
#include "laws/law.hpp"

namespace elamin {

/// Value, gradient and Hessian of an energy of two bodies by the pose variables at θ = 0, in the order (x_A, θ_A, x_B,
/// θ_B).
using PairLocal = Local<4>;

/// [a]×, the matrix of b ↦ a × b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A vector that body A carries, as body B sees it: a point at `arm` from A's position and `offset` from B's, or a
/// direction (arm = offset, and no motion of the positions changes it). World axes.
struct Carried {
  Vec3 arm, offset;
  bool point;
};

/// Adds a function φ of n vectors that A carries and B sees, Y = exp(−[θ_B]×)(exp([θ_A]×) arm + x_A − x_B), given its
/// gradient g (3n) and Hessian H (3n × 3n) by the Y. With a = arm, y = offset, and m = 1 for a point, 0 for a
/// direction,
///   J = [m I, −[a]×, −m I, [y]×],   gradient Jᵀ g,   Hessian Jᵀ H J and for each vector
///   (θ_A,θ_A): (g aᵀ + a gᵀ)/2 − (g·a) I      (θ_B,θ_B): (g yᵀ + y gᵀ)/2 − (g·y) I      (θ_A,θ_B): (g·a) I − g aᵀ
///   (x_A,θ_B): −m [g]×      (x_B,θ_B): +m [g]×      and transposes.
/// `first`: A holds the first six rows, else the last six. Only the lower triangle of the Hessian is right after this.
template <int n>
void add_carried(PairLocal& u, bool first, const std::array<Carried, n>& carried,
                 const Eigen::Matrix<double, 3 * n, 1>& gradient,
                 const Eigen::Matrix<double, 3 * n, 3 * n>& hessian) {
  const int xa = first ? 0 : 2, ta = xa + 1, xb = 2 - xa, tb = xb + 1;
  Eigen::Matrix<double, 3 * n, 12> J = Eigen::Matrix<double, 3 * n, 12>::Zero();
  for (int k = 0; k < n; ++k) {
    const Carried& c = carried[k];
    const Vec3 g = gradient.template segment<3>(3 * k);
    if (c.point) {
      J.template block<3, 3>(3 * k, 3 * xa).setIdentity();
      J.template block<3, 3>(3 * k, 3 * xb) = -Mat3::Identity();
      u.force_part(xa) += g;
      u.force_part(xb) -= g;
      const Mat3 G = cross_matrix(g);
      u.block(xa, tb) -= G, u.block(tb, xa) += G;
      u.block(xb, tb) += G, u.block(tb, xb) -= G;
    }
    J.template block<3, 3>(3 * k, 3 * ta) = -cross_matrix(c.arm);
    J.template block<3, 3>(3 * k, 3 * tb) = cross_matrix(c.offset);
    u.force_part(ta) += c.arm.cross(g);
    u.force_part(tb) -= c.offset.cross(g);
    const Mat3 ga = g * c.arm.transpose(), gy = g * c.offset.transpose();
    u.block(ta, ta) += (ga + ga.transpose()) / 2 - g.dot(c.arm) * Mat3::Identity();
    u.block(tb, tb) += (gy + gy.transpose()) / 2 - g.dot(c.offset) * Mat3::Identity();
    const Mat3 mixed = g.dot(c.arm) * Mat3::Identity() - ga;
    u.block(ta, tb) += mixed;
    u.block(tb, ta) += mixed.transpose();
  }
  const Eigen::Matrix<double, 3 * n, 12> HJ = hessian * J;
  u.hessian.noalias() += J.transpose() * HJ;
}

/// Adds a function of one point that a body carries, fixed in space otherwise, given its gradient and Hessian by the
/// place of the point, to (x, θ) of that body: J = [I, −[a]×], (θ,θ) besides: (g aᵀ + a gᵀ)/2 − (g·a) I.
inline void add_point(Local<2>& u, const Vec3& arm, const Vec3& gradient, const Mat3& hessian) {
  Eigen::Matrix<double, 3, 6> J;
  J << Mat3::Identity(), -cross_matrix(arm);
  u.gradient.noalias() += J.transpose() * gradient;
  const Mat3 ga = gradient * arm.transpose();
  u.block(1, 1) += (ga + ga.transpose()) / 2 - gradient.dot(arm) * Mat3::Identity();
  u.hessian.noalias() += J.transpose() * hessian * J;
}

/// The upper triangle of the Hessian made the mirror of the lower one.
template <int n>
void mirror(Local<n>& u) {
  for (int column = 1; column < 3 * n; ++column)
    for (int row = 0; row < column; ++row) u.hessian(row, column) = u.hessian(column, row);
}

}  // namespace elamin
