#pragma once
// An eigenmode of the Hessian at an equilibrium.
#include "model/model.hpp"

#include <string>

namespace elamin {

struct Mode {
  double eigenvalue = 0;         // of the Hessian over the free dofs [force/length]
  std::string zero_mode;         // which rigid motion it is; "": none
  Field shape;                   // 3 × sites (see Kinematics), Euclidean norm 1 over the free ones, zero where a support holds
};

/// Motion and turn of a body in a field over sites: [length], [rad].
Eigen::Matrix<double, 6, 1> body_motion(const Model& model, const Field& sites, int body);

/// The state moved along the mode, so far that what moves most (turns in units of the body's bounding radius) moves a tenth of the smallest
/// diameter.
State moved_along(const Mode& mode, const Model& model, const State& state);

}  // namespace elamin
