#pragma once
#include "solve/newton.hpp"

#include <optional>
#include <string>

namespace elamin {

struct NloptOptions {
  std::string algorithm = "LD_LBFGS";  // NLopt's name without NLOPT_
  double tolerance = 1e-10;            // residual, relative to the largest internal force
  int max_evaluations = 100'000;       // of the energy
  bool polish = false;                 // ends with Newton's method from where the algorithm has got to
  bool precondition = true;            // local methods: in variables in which the Hessian at the start is the identity
  std::optional<double> bounds = {};   // global methods: half the width of the box about the start [length]; default: as far as
                                       // half the diagonal of all particles
  unsigned long seed = 1;              // of what is random
};

/// Minimises by one of NLopt's algorithms until the residual is below the tolerance; a stationary point may be a saddle (see
/// stable_end). Local ones go in rounds, each with a factor of the Hessian of its own (see NloptSearch). Global ones look all over a box,
/// as far as nothing is in the way, with three quarters of the evaluations, and LD_LBFGS goes on from the lowest state seen.
/// What an algorithm cannot do (nlopt_refuses) is the report's sentence, not converged.
/// Source: S. G. Johnson, the NLopt nonlinear-optimization package.
[[nodiscard]] Report minimise_by_nlopt(Newton& newton, State& state, const NloptOptions& options);

/// Why an algorithm cannot solve a problem of this many dofs, with or without hard contacts: one sentence that names others that can;
/// "" if it can. Also for names that there are not.
std::string nlopt_refuses(const std::string& algorithm, int dofs, bool hard);

}  // namespace elamin
