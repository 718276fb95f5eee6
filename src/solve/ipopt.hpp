#pragma once
#include "solve/report.hpp"
#include "energy/energy.hpp"

namespace elamin {

struct IpoptOptions {
  double tolerance = 1e-10;            // residual, relative to the largest internal force
  int max_iterations = 1000;
  double barrier = 1e-3;               // where it begins, of the largest force times the mean diameter: the smaller the nearer is what is found
};

/// Interior-point minimisation with line search, exact gradients and Hessians in their fixed pattern; hard contacts are its inequality
/// constraints, gap ≥ 0, and their multipliers come back in State::hard.
/// Source: Wächter & Biegler 2006, Math. Program. 106; Ipopt 3.11.
[[nodiscard]] Report minimise_by_ipopt(Energy& energy, State& state, const IpoptOptions& options);

}  // namespace elamin
