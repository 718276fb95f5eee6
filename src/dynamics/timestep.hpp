#pragma once
// How long a step of velocity Verlet may be.
#include "energy/energy.hpp"

#include <string>

namespace elamin {

/// What bounds the step at a state. A motion M ẍ + C ẋ + K x = 0 whose drag acts with the velocity half a step back is stable
/// as long as every eigenvalue of K + 2C/dt is below 4M/dt², so certainly for
///   ω² dt² + 2 c dt < 4,   dt < 4/(c + √(c² + 4ω²)),   without drag dt < 2/ω.
struct TimestepLimit {
  double frequency = 0;            // ω, of the fastest vibration, K at the state; from above within 1 % [1/time]
  double drag = 0;                 // c, the quickest decay by drag and contact damping, from above [1/time]
  double stable = 0;               // the limit; infinity: nothing is stiff, nothing drags [time]
  int iterations = 0;              // of Lanczos's method
  /// Twenty steps a period of the fastest vibration: its frequency is met to 0.4 %. [time]
  double advised() const { return 0.314159265358979 * stable / 2; }
};

/// The limit at the state, whatever moves there. Contacts count with the stiffness that they have at the state, open ones
/// not at all: in a collision the limit may be lower. Bodies count in the coordinates (x, ℓθ) of InverseMass; pairs and walls that
/// follow LAMMPS's rules as the potential `multi` of the same kernel, without area factor and μ. Evaluates the energy with Hessian.
TimestepLimit timestep_limit(Energy& energy, const State& state);

/// Why this step is too long, in a sentence with the longest one that is not and the advised one; "" if it is not.
std::string unstable(const TimestepLimit& limit, double timestep);

}  // namespace elamin
