#pragma once
// The gaps that hard contacts keep from closing: which there are, and each as a function of the positions.
#include "energy/neighbours.hpp"
#include "model/state.hpp"

namespace elamin {

/// Whether the model has any.
bool any_hard(const Model& model);

/// Which gap a force belongs to, and an order among gaps: pairs of particles, then wall after wall.
std::array<int, 4> key(const HardForce& contact);

/// A gap c(x, λ) at a state, on one or two sites.
struct HardGap {
  int sites = 0;
  std::array<int, 2> site{};
  double value = 0;                              // c [length]
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();            // ∇c; of a wall the first three
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();             // ∇²c [1/length]
  double rate = 0;                               // ∂c/∂λ of a wall that moves [length]
  Vec3 gradient_rate = Vec3::Zero();             // ∂(∇c)/∂λ of a wall that moves
  Vec3 point = Vec3::Zero();                     // of contact: in the middle between the spheres, or on the wall
};

/// The gap of this contact at the state; false where its wall does not see the particle.
[[nodiscard]] bool hard_gap(const Model& model, const HardForce& contact, const State& state, HardGap& gap);

/// Every hard contact that may close before something has moved by `step_bound` [length] or, if there are hard pairs, by half the
/// skin of their list: of pairs all candidates, of walls the faces that are as near; each with its force in the state, or 0.
/// In ascending order.
std::vector<HardForce> hard_candidates(const Model& model, const Neighbours& neighbours, const State& state, double step_bound);

}  // namespace elamin
