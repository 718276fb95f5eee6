#pragma once
// Which solver, with its options.
#include "input/keys.hpp"
#include "solve/newton.hpp"
#include "solve/nlopt.hpp"


namespace elamin {

struct SolverTable {
  TablePlace place;
  std::string method = "auto";                  // or "newton", "ipopt", "fire", "nlopt:NAME"
  double tolerance = NewtonOptions{}.tolerance;
  std::optional<int> max_iterations;            // default: by method
  std::string petsc;                            // options for the factorisations that ranks share
  NloptOptions nlopt = {};                      // but for the algorithm and the tolerance
  bool by_newton() const { return method == "auto" || method == "newton"; }
  bool by_nlopt() const { return method.rfind("nlopt:", 0) == 0; }
  bool operator==(const SolverTable& other) const;
};

void describe(Keys& keys, SolverTable& t);

/// The iterations that a method may take where the file does not say it; none: NLopt counts evaluations.
std::optional<int> standard_iterations(const SolverTable& t);

}  // namespace elamin
