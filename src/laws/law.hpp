#pragma once
// What a law is: numbers and their mathematics on a few sites; no index, no base class, no state of the run.
#include "core/exact.hpp"

#include <concepts>

namespace elamin {

/// The positions of n sites, each as position + low (see State); differences are formed without losing a digit.
template <int n>
struct Points {
  Eigen::Matrix<double, 3, n> position = Eigen::Matrix<double, 3, n>::Zero();
  Eigen::Matrix<double, 3, n> low = Eigen::Matrix<double, 3, n>::Zero();

  Points() = default;
  /// From plain positions, 3 × n.
  explicit Points(const Eigen::Matrix<double, 3, n>& x) : position(x) {}

  /// x_j − x_i, to about 32 digits.
  ExactVector edge(int i, int j) const {
    return ExactVector{position.col(j), low.col(j)} - ExactVector{position.col(i), low.col(i)};
  }
};

/// Value, gradient (3n) and Hessian (3n × 3n, symmetric) of a law on n sites; site i holds the rows 3i, 3i+1, 3i+2.
template <int n>
struct Local {
  double value = 0;
  Eigen::Matrix<double, 3 * n, 1> gradient = Eigen::Matrix<double, 3 * n, 1>::Zero();
  Eigen::Matrix<double, 3 * n, 3 * n> hessian = Eigen::Matrix<double, 3 * n, 3 * n>::Zero();

  auto force_part(int i) { return gradient.template segment<3>(3 * i); }
  auto block(int i, int j) { return hessian.template block<3, 3>(3 * i, 3 * j); }
};

/// uᵀHv, a sum over the elements, and the sum of the sizes of all that is added to form it,
///   size = Σ_e |u_e|ᵀ |H_e| |v_e|,   u_e, v_e the parts of u and v that the element sees:
/// a few ε times it bound what rounding does to the value, however much of it cancels (Higham 2002, Accuracy and Stability of
/// Numerical Algorithms, §3.1).
struct BilinearForm {
  double value = 0, size = 0;
};

/// A law says on how many sites it acts, and gives its energy alone or with both derivatives.
/// Outside its domain it returns +inf; it never throws.
template <class L>
concept Law = requires(const L& law, const Points<L::sites>& x) {
  { L::sites } -> std::convertible_to<int>;
  { law.value(x) } -> std::same_as<double>;
  { law.derivatives(x) } -> std::same_as<Local<L::sites>>;
};

/// A law whose elements stand in space, like weights: only the sum of all of them may be free of where that is.
template <class L>
concept AnchoredLaw = Law<L> && (L::sites == 1 || requires { requires L::anchored; });

/// A law that forms uᵀHv (u, v: 3 × n, in columns) with less rounding than the entries of its Hessian have.
template <class L>
concept FormLaw = Law<L> && requires(const L& law, const Points<L::sites>& x, const Eigen::Matrix<double, 3, L::sites>& u) {
  { law.form(x, u, u) } -> std::same_as<BilinearForm>;
};

/// A law with parameters that may change: ∂(∇U)/∂λ for given rates ∂/∂λ of its parameters, which are those of `rate`.
template <class L>
concept ChangingLaw = Law<L> && requires(const L& law, const L& rate, const Points<L::sites>& x) {
  { law.gradient_rate(x, rate) } -> std::same_as<Eigen::Matrix<double, 3 * L::sites, 1>>;
};

}  // namespace elamin
