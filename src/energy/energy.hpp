#pragma once
// The total energy of a model as a function of its free dofs and of the load factor.
#include "energy/assembler.hpp"
#include "energy/terms.hpp"

namespace elamin {

/// E(q, λ) = Σ U_bond + Σ U_angle − Σ F(λ)·x,   F(λ) = F₀ + λ F₁ (dead loads and weights).
/// The topology is taken once from the model, which must outlive this. Not for use by several threads at once;
/// inside, every evaluation is shared over the cores with the same bits for any number of them.
class Energy {
 public:
  explicit Energy(const Model& model);
  Energy(const Energy&) = delete;
  Energy& operator=(const Energy&) = delete;

  const Model& model() const { return model_; }
  const Kinematics& kinematics() const { return kinematics_; }
  int dofs() const { return kinematics_.dofs(); }

  /// Energies by term [energy]; +inf where a law is outside its domain.
  EnergyTerms terms(const State& state);
  double value(const State& state) { return terms(state).total(); }

  /// Evaluates energy and derivatives at the state; the results below hold until the next call. With `from`, the state
  /// that a step came from, the Hessian takes the forces predicted there for its geometric part (see HarmonicBond): the
  /// same at an equilibrium, far better than the exact one after a long step of a slender structure.
  void evaluate(const State& state, bool with_hessian = true, const State* from = nullptr);
  /// Energy at the state that the linearisation at `from` did not predict: what the next step will take out again.
  double unpredicted(const State& state, const State& from) { return assembler_->unpredicted(state, from); }
  const EnergyTerms& last_terms() const { return terms_; }
  const Vector& gradient() const { return gradient_; }        // g = ∂E/∂q (dofs) [force]
  const SparseMatrix& hessian() const { return *hessian_; }   // H = ∂²E/∂q∂q, lower triangle [force/length]
  const SparseMatrix& pattern() const { return assembler_->pattern(); }
  /// ∂g/∂λ (dofs): −F₁ and what the driven points pull; exact.
  Vector load_derivative() const;
  /// H v (dofs) and vᵀHv formed from differences of v element by element: more digits than the assembled Hessian has.
  Vector multiply(const Vector& v) const;
  double quadratic_form(const Vector& v) const { return assembler_->quadratic_form(kinematics_.extend(v)); }
  /// Largest |s_j − s_i|/|x_j − x_i| over the bonds: how much a step turns or stretches what is glued.
  double distortion(const State& state, const Vector& step) const;
  /// The scale of internal forces: the largest force of one element on a particle, or of one load if that is larger.
  double force_scale() const { return force_scale_; }
  /// Rounding's own force: ε times the largest stiffness times bond length; forces below it are zero. [force]
  double force_floor() const { return force_floor_; }
  /// The largest component of a force on the free dofs (dofs), relative to the scale of internal forces: a residual.
  double relative(const Vector& force) const;

  /// −∂U/∂x of all particles, loads included, held or not: 3 × particles [force]. At a held coordinate of an
  /// equilibrium it is minus the reaction.
  Field forces(const State& state);

 private:
  double external(const State& state) const;
  void finish_gradient(const State& state);

  const Model& model_;
  Kinematics kinematics_;
  Assembler::Groups groups_;
  std::unique_ptr<Assembler> assembler_;
  Field constant_load_, scaled_load_;                         // F₀, F₁: 3 × particles
  Field site_gradient_;
  Vector gradient_;
  const SparseMatrix* hessian_ = nullptr;
  EnergyTerms terms_;
  double force_scale_ = 0, force_floor_ = 0;
};

}  // namespace elamin
