#pragma once
// One run of NLopt's algorithms on an energy.
#include "solve/newton.hpp"
#include "solve/nlopt.hpp"
#include "solve/nlopt_algorithms.hpp"

#include <exception>
#include <string>

namespace elamin {

/// The energy about a base state q₀ as a function of variables z in which it is well scaled,
///   f(z) = (E(q₀ + √e W z) − E₀) / e,   ∂f/∂z = Wᵀ g / √e,
/// W Wᵀ = (H₀ + τI)⁻¹ and e = g₀ᵀ W Wᵀ g₀: its Hessian at z = 0 is the identity, the slope there is 1. A slender chain of N
/// particles has a condition number of 5 N⁴ otherwise. (Without the factor W ∝ I, as the stiffest
/// diagonal entry of H₀ has it.) The search goes round
/// after round, each about the best state so far with its own factor.
///
/// Where the changes of energy that a round can make are lost in the rounding of E, they are formed from the forces,
///   f(z) = (γ₀ + γ)·z / 2,   γ = ∂f/∂z,
/// which is E's change but for terms of third order, and those vanish as the rounds draw near; the best state is then
/// the one with the smallest residual.
///
/// States that cannot be reached from the best one without passing through something, or that have no finite energy, are barred: f
/// rises there above all that was seen.
class NloptSearch {
 public:
  NloptSearch(Newton& newton, const State& start, const NloptOptions& options, Report& report);

  /// Rounds of a local algorithm until the residual is below the tolerance.
  void local(const NloptAlgorithm& algorithm);
  /// All over the box |q − q₀| ≤ half, for that many evaluations; then in the lowest state that was seen.
  void global(const NloptAlgorithm& algorithm, double half, int evaluations);
  const State& state() const { return best_; }

 private:
  enum class Space { preconditioned, scaled, box };
  static double call(unsigned n, const double* z, double* gradient, void* self);
  double value(const Vector& z, double* gradient);
  double barred(const Vector& z, double* gradient);
  Vector step(const Vector& z);
  Vector slope(const Vector& g);
  bool begin_round(bool from_forces);
  [[nodiscard]] std::optional<double> factorise(const Vector& g);
  void optimise(nlopt_opt optimiser);
  [[nodiscard]] bool must_stop();
  void keep(const State& state, double f, double residual);
  void end(Status status, std::string why);

  Newton& newton_;
  Energy& energy_;
  const NloptOptions& options_;
  Report& report_;
  State base_, best_;
  Space space_ = Space::preconditioned;
  double length_ = 1;              // of a variable, where they are not preconditioned
  double unit_ = 1;                // e [energy]
  double base_energy_ = 0, base_residual_ = 0, best_value_ = 0, best_residual_ = 0, worst_ = 0;
  double shift_ = 0, extent_ = 0;
  Vector base_slope_;              // γ₀
  bool from_forces_ = false;
  bool whole_space_ = false;       // a small residual is not yet the end
  int looks_ = 0, last_gain_ = 0;  // of this round: calls, and at which the best state was found
  int most_looks_ = 0, patience_ = 0;
  nlopt_opt running_ = nullptr;
  std::exception_ptr thrown_;
  int most_evaluations_ = 0;
};

}  // namespace elamin
