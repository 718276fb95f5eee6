#pragma once
// What a solver answers: not converging is a result, not an exception.
#include <string>
#include <vector>

namespace elamin {

enum class Status { converged, not_converged, interrupted };

/// One iteration, for the log.
struct Iteration {
  double energy = 0;        // [energy]
  double residual = 0;      // largest force on a free dof / largest internal force
  double step = 0;          // largest movement of a dof [length]
  double shift = 0;         // added to the Hessian's diagonal to make it positive definite [force/length]
};

struct Report {
  Status status = Status::not_converged;
  std::string why;          // one sentence
  std::vector<Iteration> history;
  int iterations = 0, factorizations = 0, evaluations = 0;
  double energy = 0;        // [energy]
  double residual = 0;      // relative to the largest internal force
  int negative = -1;        // Morse index where the solver learnt it, else -1
  double seconds = 0, factor_seconds = 0;   // in all; in analyses, factorisations and solves
  bool converged() const { return status == Status::converged; }
};

}  // namespace elamin
