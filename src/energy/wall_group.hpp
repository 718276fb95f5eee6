#pragma once
// Particles at walls: one element for every particle of every wall's group.
#include "energy/law_group.hpp"
#include "laws/wall_contact.hpp"
#include "model/model.hpp"

namespace elamin {

/// The wall as it stands at the load factor λ: moved by s(λ) d, its radius larger by s(λ) ΔR. A hard one has no modulus: what
/// it does is in HardWallGroup.
WallContact wall_at(const Wall& wall, double load_factor);

/// U of all walls. They move with the load factor themselves:
///   ∂(∇U)/∂λ = s′ (−∇∇U d + ∂(∇U)/∂R ΔR).
class WallGroup final : public ElementGroup {
 public:
  /// Of the particles that are wanted.
  WallGroup(const Model& model, const std::function<bool(int)>& wanted);

  int elements() const override { return static_cast<int>(particle_.size()); }
  int sites() const override { return 1; }
  std::span<const int> stencils() const override { return particle_; }
  void values(const State& state, double* value) const override;
  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override;
  bool residual_energy(const State&, const State&, double*) const override { return false; }
  bool load_dependent() const override { return load_dependent_; }
  void explicit_load_derivative(const State& state, double* rate) const override;

 private:
  const std::vector<WallContact>& at(double load_factor) const;
  const Model& model_;
  mutable std::vector<WallContact> walls_;     // as they stand at the load factor asked for last
  std::vector<int> particle_, wall_;           // of every element
  bool load_dependent_ = false;
};

}  // namespace elamin
