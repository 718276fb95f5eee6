#pragma once
// ∂g/∂λ of an energy from differences of its gradient.
#include "energy/energy.hpp"
#include "laws/check_law.hpp"

namespace elamin {

/// With the prescribed coordinates moved along: fourth order, h in load factors.
inline Vector load_difference(Energy& energy, const State& state, double h) {
  return difference([&](double s) -> Vector {
    State moved = state;
    energy.kinematics().prescribe(moved, state.load_factor + s);
    energy.evaluate(moved, false);
    return energy.gradient();
  }, h);
}

/// A step of fourth-order differences and what they leave.
const double difference_step = std::pow(epsilon, 0.2), difference_error = 100 * std::pow(epsilon, 0.8);

/// The start at this load factor with every free dof moved, by up to `size` [length].
inline State bent(const Energy& energy, double load_factor, double size = 0.1) {
  State state = energy.model().start;
  energy.kinematics().prescribe(state, load_factor);
  Vector step(energy.dofs());
  for (Eigen::Index k = 0; k < step.size(); ++k) step[k] = size * std::sin(1.7 * static_cast<double>(k));
  energy.kinematics().retract(state, step);
  return state;
}

}  // namespace elamin
