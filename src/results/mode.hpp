#pragma once
// An eigenmode of the Hessian at an equilibrium.
#include "model/model.hpp"

#include <string>

namespace elamin {

struct Mode {
  double eigenvalue = 0;         // of the Hessian over the free dofs [force/length]
  std::string zero_mode;         // which rigid motion it is; "": none
  Field shape;                   // 3 × particles, Euclidean norm 1, zero where a support holds
};

/// The state moved along the mode, so far that the particle that moves most moves a tenth of the smallest diameter.
State moved_along(const Mode& mode, const Model& model, const State& state);

}  // namespace elamin
