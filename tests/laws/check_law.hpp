#pragma once
// What every law must satisfy at a set of points, held against differences of its own value.
#include "laws/law.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace elamin {

/// The points with coordinate k (site 3k/3, component k mod 3) moved by h, kept exactly.
template <int n>
Points<n> moved(const Points<n>& x, int k, double h) {
  Points<n> y = x;
  const Exact e = Exact{x.position(k % 3, k / 3), x.low(k % 3, k / 3)} + h;
  y.position(k % 3, k / 3) = e.hi, y.low(k % 3, k / 3) = e.lo;
  return y;
}

/// The shortest distance of neighbouring points.
double shortest_edge(const auto& x) {
  double shortest = 1e300;
  for (int i = 0; i + 1 < x.position.cols(); ++i) shortest = std::min(shortest, x.edge(i, i + 1).hi.norm());
  return shortest;
}

/// Fourth-order central difference (8(f(h) − f(−h)) − (f(2h) − f(−2h)))/12h.
template <class F>
auto difference(const F& f, double h) {
  const auto near_right = f(h), near_left = f(-h), far_right = f(2 * h), far_left = f(-2 * h);
  std::remove_const_t<decltype(near_right)> slope = (8 * (near_right - near_left) - (far_right - far_left)) / (12 * h);
  return slope;
}

/// Everything that is wrong with the law at these points, one sentence each; empty: nothing.
/// length: the smallest distance over which the law changes by its own size (sites that nearly meet: their distance).
/// With h = length·ε^{1/5} a fourth-order difference is good to about ε^{4/5} of the scale of what is differenced.
template <Law L>
std::vector<std::string> check_law(const L& law, const Points<L::sites>& x, double length) {
  constexpr int n = L::sites;
  std::vector<std::string> wrong;
  const auto demand = [&](bool holds, const std::string& what) { if (!holds) wrong.push_back(what); };
  const Local<n> u = law.derivatives(x);
  const double h = length * std::pow(epsilon, 0.2), accuracy = 100 * std::pow(epsilon, 0.8);
  const double force = u.gradient.norm() + std::abs(u.value) / length + u.hessian.norm() * length;

  demand(u.value == law.value(x), fmt::format("value {} beside derivatives {} alone", law.value(x), u.value));
  demand(std::isfinite(u.value) && u.gradient.allFinite() && u.hessian.allFinite(), "not finite");
  demand(u.hessian == u.hessian.transpose(), "Hessian not symmetric");
  demand(u.hessian.norm() > 0, "Hessian is zero");
  for (int k = 0; k < 3 * n; ++k) {
    const double slope = difference([&](double s) { return law.value(moved<n>(x, k, s)); }, h);
    demand(std::abs(slope - u.gradient[k]) <= accuracy * force, fmt::format("gradient {}: {} by differences {}", k, u.gradient[k], slope));
    const Eigen::Matrix<double, 3 * n, 1> column =
        difference([&](double s) -> Eigen::Matrix<double, 3 * n, 1> { return law.derivatives(moved<n>(x, k, s)).gradient; }, h);
    demand((column - u.hessian.col(k)).cwiseAbs().maxCoeff() <= accuracy * force / length,
           fmt::format("Hessian column {}: off by {} of {}", k, (column - u.hessian.col(k)).cwiseAbs().maxCoeff(), u.hessian.norm()));
  }
  if constexpr (AnchoredLaw<L>) return wrong;  // in a field that is fixed in space nothing sums to zero
  Vec3 total = Vec3::Zero(), torque = Vec3::Zero();
  double extent = 0;
  for (int i = 0; i < n; ++i) {
    const ExactVector arm = x.edge(0, i);
    total += u.gradient.template segment<3>(3 * i);
    torque += arm.hi.cross(Vec3(u.gradient.template segment<3>(3 * i)));
    extent = std::max(extent, arm.hi.norm());
  }
  demand(total.norm() <= 16 * epsilon * u.gradient.norm(), fmt::format("forces sum to {}", total.norm()));
  demand(torque.norm() <= 32 * epsilon * extent * u.gradient.norm(), fmt::format("torques sum to {}", torque.norm()));
  return wrong;
}

/// Sites at random in a cube of this size, the same on every call.
template <int n>
Points<n> random_points(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> in(-size / 2, size / 2);
  Eigen::Matrix<double, 3, n> x;
  for (Eigen::Index k = 0; k < x.size(); ++k) x.data()[k] = in(random);
  return Points<n>(x);
}

}  // namespace elamin
