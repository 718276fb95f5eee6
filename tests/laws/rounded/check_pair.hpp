#pragma once
// What a law of two bodies must satisfy at a pair of poses, held against differences of its own value.
#include "laws/check_law.hpp"
#include "laws/rounded/bodies.hpp"

namespace elamin {

/// The left Jacobian of the rotations: exp([θ + δ]×) = exp([J δ]×) exp([θ]×) to first order in δ.
inline Mat3 left_jacobian(const Vec3& theta) {
  const double t = theta.norm(), t2 = t * t;
  const Mat3 C = cross_matrix(theta);
  if (t < 1e-3) return Mat3::Identity() + (0.5 - t2 / 24) * C + (1.0 / 6 - t2 / 120) * C * C;
  return Mat3::Identity() + (1 - std::cos(t)) / t2 * C + (t - std::sin(t)) / (t2 * t) * C * C;
}

/// A law of two bodies by the motions (dx, `unit` θ) of A and of B away from a pair of poses. Its gradient is
/// by these coordinates wherever they are, so differences of it are true second derivatives; its Hessian is that at
/// zero.
template <class L>
struct AtPoses {
  L law;
  Couple couple;
  double unit = 1;                             // length: makes angles lengths

  Couple at(const Points<4>& x) const {
    Eigen::Matrix<double, 12, 1> step;
    for (int k = 0; k < 4; ++k)
      step.segment<3>(3 * k) = (x.position.col(k) + x.low.col(k)) / (k % 2 == 1 ? unit : 1.0);
    return moved(couple, step);
  }
  double value(const Points<4>& x) const { return law.value(at(x).a, at(x).b); }
  PairLocal derivatives(const Points<4>& x) const {
    const Couple c = at(x);
    PairLocal u = law.derivatives(c.a, c.b);
    Eigen::Matrix<double, 12, 12> scale = Eigen::Matrix<double, 12, 12>::Identity();
    for (const int k : {1, 3}) {
      const Vec3 theta = (x.position.col(k) + x.low.col(k)) / unit;
      u.force_part(k) = (left_jacobian(theta).transpose() * u.force_part(k)).eval();
      scale.block<3, 3>(3 * k, 3 * k) /= unit;
    }
    u.gradient = (scale * u.gradient).eval(), u.hessian = (scale * u.hessian * scale).eval();
    return u;
  }
};

/// Everything that is wrong, one sentence each. `length`: the smallest over which the law changes by its own size.
/// Differences as in check_law; besides their error that of rounding the places of the features, ε times the size of
/// the bodies, counts.
template <class L>
std::vector<std::string> check_pair(const L& law, const Couple& c, double length) {
  std::vector<std::string> wrong;
  const auto demand = [&](bool holds, const std::string& what) { if (!holds) wrong.push_back(what); };
  const double size = c.a.shape->bounding_radius() + c.b.shape->bounding_radius();
  const AtPoses<L> at{law, c, size};
  const Points<4> here;
  const PairLocal u = at.derivatives(here);
  const double h = length * std::pow(epsilon, 0.2),
      force = u.gradient.norm() + std::abs(u.value) / length + u.hessian.norm() * length;
  const double accuracy = 100 * std::pow(epsilon, 0.8), rounding = 16 * epsilon * size / h;

  demand(u.value == at.value(here), fmt::format("value {} beside derivatives {} alone", at.value(here), u.value));
  demand(std::isfinite(u.value) && u.gradient.allFinite() && u.hessian.allFinite(), "not finite");
  demand(u.hessian == u.hessian.transpose(), "Hessian not symmetric");
  for (int k = 0; k < 12; ++k) {
    const double slope = difference([&](double s) { return at.value(moved<4>(here, k, s)); }, h);
    demand(std::abs(slope - u.gradient[k]) <= (accuracy + rounding) * force,
        fmt::format("gradient {}: {} by differences {}", k, u.gradient[k], slope));
    const auto gradient = [&](double s) -> Eigen::Matrix<double, 12, 1> {
      return at.derivatives(moved<4>(here, k, s)).gradient;
    };
    const Eigen::Matrix<double, 12, 1> column = difference(gradient, h);
    const double off = (column - u.hessian.col(k)).cwiseAbs().maxCoeff();
    demand(off <= (accuracy + rounding) * force / length,
        fmt::format("Hessian column {}: off by {} of {}", k, off, u.hessian.norm()));
  }
  const PairLocal plain = law.derivatives(c.a, c.b);
  const Vec3 arm = (c.b.pose.position - c.a.pose.position).hi, on_b = plain.gradient.segment<3>(6);
  const Vec3 torque = plain.gradient.segment<3>(3) + plain.gradient.segment<3>(9) + arm.cross(on_b);
  demand(plain.gradient.segment<3>(0) == -on_b, "forces do not sum to zero");
  demand(torque.norm() <= 64 * epsilon * size * force, fmt::format("torques sum to {}", torque.norm()));
  return wrong;
}

}  // namespace elamin
