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

}  // namespace elamin
