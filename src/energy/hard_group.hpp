#pragma once
// Hard contacts in the Lagrangian L = E − Σ f c: the forces f come with the state, and so does whether there is one.
#include "energy/law_group.hpp"
#include "energy/neighbours.hpp"

namespace elamin {

/// −Σ f c of the candidate pairs: derivatives of the Lagrangian; as an energy each is zero, for f c = 0 at an equilibrium.
class HardPairGroup final : public ElementGroup {
 public:
  HardPairGroup(const Model& model, const std::vector<IndexPair>& pairs);

  int elements() const override { return static_cast<int>(stencils_.size()); }
  int sites() const override { return 2; }
  std::span<const int> stencils() const override { return in_a_row(stencils_); }
  void values(const State& state, double* value) const override;
  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override;
  bool residual_energy(const State&, const State&, double*) const override { return false; }

 private:
  const Model& model_;
  std::vector<std::array<int, 2>> stencils_;   // ascending
};

/// The same of hard walls, one element for every particle of every wall's group. They move with the load factor themselves:
///   ∂(∇L)/∂λ = −f ∂(∇c)/∂λ.
class HardWallGroup final : public ElementGroup {
 public:
  explicit HardWallGroup(const Model& model);

  int elements() const override { return static_cast<int>(particle_.size()); }
  int sites() const override { return 1; }
  std::span<const int> stencils() const override { return particle_; }
  void values(const State& state, double* value) const override;
  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override;
  bool residual_energy(const State&, const State&, double*) const override { return false; }
  bool load_dependent() const override { return load_dependent_; }
  void explicit_load_derivative(const State& state, double* rate) const override;

 private:
  int element_of(int wall, int particle) const;
  const Model& model_;
  std::vector<int> first_, particle_;          // of every wall its first element; of every element
  bool load_dependent_ = false;
};

}  // namespace elamin
