#pragma once
// The total energy of a model as a function of its free dofs and of the load factor.
#include "energy/assembler.hpp"
#include "energy/body_neighbours.hpp"
#include "energy/hard_gaps.hpp"
#include "energy/neighbours.hpp"
#include "energy/collision_free_step.hpp"
#include "energy/terms.hpp"
#include "energy/touch.hpp"

#include <utility>

namespace elamin {

struct Parts;

/// E(q, λ) = Σ U_bond + Σ U_angle + Σ U_contact + Σ U_cohesion + Σ U_body + Σ U_wall(λ) + Σ p(λ) A − Σ F(λ)·x − Σ τ(λ)·φ,
/// and what a program adds; F(λ) = F₀ + λ F₁ (dead loads and weights); of bonds and angles that changes act on, r₀, K and B depend on λ too. Rounded
/// bodies that follow LAMMPS's rules feel nothing here. The topology is taken once from the model, which must outlive this; the candidates of contact are looked for
/// anew whenever a state is evaluated that the last list does not cover, so that no contact is ever missed. Not for use by
/// several threads at once; inside, every evaluation is shared over the cores with the same bits for any number of them.
/// Hard contacts have no energy. With the forces f of State::hard, gradient, Hessian, load_derivative and forces are those of
/// the Lagrangian  L = E − Σ f c,  c the gaps: at an equilibrium ∂L/∂q = 0, c ≥ 0, f ≥ 0 and f c = 0.
class Energy {
 public:
  explicit Energy(const Model& model);
  Energy(const Energy&) = delete;
  Energy& operator=(const Energy&) = delete;

  /// Adds the elements of a law that the model does not know (see LawGroup), with their energy as the term of that name. Their sites count as
  /// held by them, as by bonds. What moves in time does not feel them. Throws std::invalid_argument where the name is a term that there is, a
  /// site is none of the model's or an element has more than 12 sites.
  void add(const std::string& term, std::unique_ptr<ElementGroup> group);

  const Model& model() const { return model_; }
  const Kinematics& kinematics() const { return kinematics_; }
  int dofs() const { return kinematics_.dofs(); }

  /// Energies by term [energy]; +inf where a law is outside its domain.
  EnergyTerms terms(const State& state);
  double value(const State& state) { return terms(state).total(); }

  /// The energy of all laws, but not of loads and pressures, by particles and bodies (see model/entities.hpp): that of an element in
  /// equal parts on all that it is between [energy].
  Vector shares(const State& state);

  /// Evaluates energy and derivatives at the state; the results below hold until the next call. With `from`, the state
  /// that a step came from, the Hessian takes the forces predicted there for its geometric part (see HarmonicBond): the
  /// same at an equilibrium, far better than the exact one after a long step of a slender structure.
  void evaluate(const State& state, bool with_hessian = true, const Tangent& tangent = {});
  /// The same with Hessian, unless the last evaluation was that; with laws of a program's own, which may have changed meanwhile, always.
  void be_at(const State& state);
  /// Energy at the state that the linearisation at `from` did not predict: what the next step will take out again.
  double residual_energy(const State& state, const State& from) { return assembler_->residual_energy(state, from); }
  const EnergyTerms& last_terms() const { return terms_; }
  const Vector& gradient() const { return gradient_; }        // g = ∂E/∂q (dofs) [force]
  /// H = ∂²E/∂q∂q, lower triangle [force/length]; its pattern is there before any evaluation.
  const SparseMatrix& hessian() const { return std::as_const(*assembler_).hessian(); }
  /// The same, for whoever changes coordinates until the next evaluation.
  SparseMatrix& changeable_hessian() { return current_ = false, assembler_->hessian(); }
  /// Free dofs of single particles that nothing gives a stiffness, at the last evaluation with Hessian: grains that fly, or
  /// slide on a plane. On the diagonal of hessian() they have |gᵢ|/2d, so that a step of Newton's method lets a grain
  /// fall by two diameters, or where no force acts on them the largest stiffness there is, so that they stay.
  const std::vector<int>& null_dofs() const { return null_dofs_; }
  /// Free dofs of bodies, and of particles that no bond and no angle holds.
  const std::vector<int>& unbonded_dofs() const { return unbonded_dofs_; }
  /// Grows by one whenever the pattern of the Hessian changes, with the candidates of contact.
  int pattern_version() const { return pattern_version_; }
  /// ∂g/∂λ (dofs): −F₁, what the driven points pull, and of walls, pressures and changes; exact.
  Vector load_derivative() const;
  /// The part of −∂g/∂λ (dofs) that is a force given from outside: of dead loads, weights and pressures.
  Vector load_force() const;
  /// Whether the load factor scales any such force.
  bool loads_scaled() const;
  /// H v (dofs), vᵀHv and uᵀHv formed from differences of u and v element by element: more digits than the assembled Hessian has, and of
  /// bonds more than the entries of an element's Hessian (FormLaw).
  /// Idle dofs have the stiffness that they have in hessian().
  Vector multiply(const Vector& v, bool anchored = true) const;
  double quadratic_form(const Vector& v) const { return form(v, v).value; }
  BilinearForm form(const Vector& u, const Vector& v) const;
  /// gᵀv, the slope of the energy along v (dofs) [energy], formed in the same way: along a soft motion the rounded sum of forces is noise. Its
  /// rounding is some ε times the size, the root of the sum of the terms' squares, as errors are independent.
  BilinearForm slope(const Vector& v) const;
  /// Where the last evaluation with Hessian was.
  const State& evaluated() const { return evaluated_; }
  /// Largest part of the way from → to, in (0, 1], on which nothing passes through anything (see collision_free_particle_step, collision_free_body_step).
  double collision_free_step(const State& from, const State& to) const;
  const BodyRules& body_rules() const { return body_neighbours_.rules(); }
  const BodyNeighbours& body_neighbours() const { return body_neighbours_; }
  const ContactRules& contact_rules() const { return neighbours_.rules(); }
  /// The scale of internal forces: the largest force of one element on a particle, or of one load if that is larger.
  double force_scale() const { return force_scale_; }
  /// What that is taken to be at least, for where there is no force: rounding of what is stiffest.
  double force_floor() const { return force_floor_; }
  /// Whether nothing at the evaluated state bears a force: particles overlap by less than 1e-15 of their size then, bodies by 1e-12; what bonds and angles
  /// bear where they are at rest is rounding of rest lengths, rest angles and places.
  bool slack() const { return other_force_ <= no_force() && glue_force_ <= glue_rounding_; }
  /// A force that counts as none.
  double no_force() const { return nothing * force_floor_; }
  /// The largest component of a force on the free dofs (dofs), relative to the scale of internal forces: a residual.
  double relative(const Vector& force) const;

  /// Every contact that is closed, and every one whose gap is at most `within` [length]: pairs in ascending order, then wall
  /// after wall; particles and bodies, see Touch. A hard contact is closed where it bears a force.
  std::vector<Touch> touches(const State& state, double within = 0);

  /// Looks for the candidates of contact now: from here on every particle may move by freedom() before that happens again.
  void look_around(const State& state);
  /// The hard contacts that may close while every particle moves by less than `step_bound`, and by less than freedom() from where the
  /// candidates were looked for last; with their forces. Not those between what is prescribed altogether.
  std::vector<HardForce> hard_contacts(const State& state, double step_bound);
  /// How far particles may move until the candidates of contact are looked for anew; infinity: there are none. [length]
  double freedom() const { return neighbours_.freedom(); }

  /// Gap of two particles (wall −1), or of a particle and the nearest face of a wall (other −1): distance of the surfaces,
  /// negative: overlap; infinity where the wall does not see the particle. [length]
  double gap(int particle, int other, int wall, const State& state) const;

  /// −∂U/∂x of all sites, loads included, prescribed or not: 3 × sites [force]; of a rotation the torque about the body's position over
  /// its characteristic length. At a prescribed coordinate of an equilibrium it is minus the reaction. Of a glued particle it is what acts on it; its
  /// body's has it too.
  Field forces(const State& state);

  /// The candidates of contact, whose order sums follow: all that the past leaves behind.
  void carry(Archive& archive);

 private:
  double external(const State& state) const;
  void finish_gradient(const State& state);
  void cover(const State& state);
  void anchor_null_dofs();
  void put(int place, Parts parts);
  void assemble_groups();
  EnergyTerms terms_of(const std::vector<double>& sums, const State& state) const;

  const Model& model_;
  Kinematics kinematics_;
  Neighbours neighbours_;
  BodyNeighbours body_neighbours_;
  Assembler::Groups groups_;                                  // by place: see energy.cpp
  std::unique_ptr<Assembler> assembler_;
  double load_factor_ = 0;                                     // of the last evaluation
  Field constant_load_, scaled_load_;                         // F₀, F₁: 3 × sites, of what nothing carries
  Field site_gradient_;
  Vector gradient_, row_sums_;
  State evaluated_;                                           // with Hessian, last …
  bool predicted_ = false;                                    // … which takes forces predicted from another state
  bool current_ = false;                                      // whether all that an evaluation leaves is of it, and takes none
  int pattern_version_ = 0;
  EnergyTerms terms_;
  static constexpr double nothing = 1e-7;                     // of the floor: well above what residuals leave, 1e-10 of it
  double force_scale_ = 0, force_floor_ = 0;
  double glue_force_ = 0, other_force_ = 0, glue_rounding_ = 0;            // the largest of bonds and angles, of everything else
  std::vector<int> unbonded_dofs_, null_dofs_;                             // free dofs of single particles and bodies; those without stiffness
  std::vector<std::string> own_;                              // terms of the groups behind those of the model
};

}  // namespace elamin
