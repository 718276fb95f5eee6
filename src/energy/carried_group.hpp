#pragma once
// Elements with particles that rigid bodies carry.
#include "energy/kinematics.hpp"
#include "energy/law_group.hpp"

#include <memory>

namespace elamin {

/// The elements of another group with three sites for each of its n: the site itself, and of a glued particle the place and the rotation of
/// its body (−1, no site, for others). With a the arm from the body to the particle, g and H the derivatives by the particle's place,
///   J = [I, −[a]×],   gradient Jᵀ g,   Hessian Jᵀ H J and, rotation by rotation, (g aᵀ + a gᵀ)/2 − (g·a) I.
/// The site itself has the gradient g, so that the force on the particle is known; its Hessian is with the body.
class CarriedGroup final : public ElementGroup {
 public:
  CarriedGroup(const Model& model, const Kinematics& kinematics, std::unique_ptr<ElementGroup> inner);

  int elements() const override { return inner_->elements(); }
  int sites() const override { return 3 * inner_->sites(); }
  std::span<const int> stencils() const override { return stencils_; }
  std::span<const int> between(int e) const override { return inner_->between(e); }
  void values(const State& state, double* value) const override { inner_->values(state, value); }
  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override;
  bool residual_energy(const State& state, const State& from, double* value) const override { return inner_->residual_energy(state, from, value); }
  bool anchored() const override { return true; }
  bool load_dependent() const override { return inner_->load_dependent(); }
  void explicit_load_derivative(const State& state, double* rate) const override;

 private:
  /// The chain rule of one element: from n sites to 3n.
  Eigen::MatrixXd jacobian(const State& state, int e) const;
  Vec3 arm(const State& state, int particle) const;
  Eigen::VectorXd spread(const State& state, int e, const double* inner_gradient) const;

  const Kinematics& kinematics_;
  std::unique_ptr<ElementGroup> inner_;
  std::vector<Glued> glued_;
  std::vector<int> glue_;                      // of each particle in glued_, −1: none
  std::vector<int> stencils_;
  mutable std::vector<double> gradient_, hessian_;   // of the inner group
};

}  // namespace elamin
