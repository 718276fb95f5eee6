#pragma once
// To an equilibrium by moving: damped dynamics with masses of its own.
#include "energy/energy.hpp"
#include "solve/report.hpp"

namespace elamin {

struct RelaxOptions {
  double tolerance = 1e-10;                     // residual, relative to the largest internal force
  std::int64_t max_steps = 200'000;
};

/// Falls to a minimum with FIRE (Bitzek et al. 2006, semi-implicit as Guénolé et al. 2020): velocity Verlet whose velocity is
/// turned towards the force, and stopped wherever it points uphill. Each free coordinate has the mass Σ |Kᵢⱼ| of its row of
/// the stiffness, so that no frequency is above 1 and every coordinate is as quick as it can be: the steps needed grow with
/// the square root of the condition number. No step is longer than a twentieth of the smallest diameter that can touch
/// something, so that nothing passes through anything. Prescribed coordinates stay where they are.
/// Bodies: in the coordinates (x, ℓθ), a step no longer than a tenth of the radius of their rounding, by the exact forces throughout.
/// Plain doubles while the residual is above what they can tell; the exact forces of the energy from there on.
/// The history has every thousandth step. Report::negative stays −1: a saddle is left sooner or later, but not looked for.
[[nodiscard]] Report relax(Energy& energy, State& state, const RelaxOptions& options = {});

}  // namespace elamin
