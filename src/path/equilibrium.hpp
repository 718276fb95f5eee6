#pragma once
// One equilibrium with what its neighbours are computed from.
#include "model/entities.hpp"
#include "model/rigid_motion.hpp"
#include "path/options.hpp"
#include "solve/newton.hpp"

namespace elamin {

struct Equilibrium {
  PathPoint point;
  Vector tangent;                      // dx/dλ at fixed zero modes (dofs) [length]
  Eigen::MatrixXd zero_modes;          // orthonormal, dofs × count: rigid motions and symmetries that cost nothing
  std::vector<RigidMotion> motions = {};   // the rigid ones that they have been told to be
  Eigen::MatrixXd soft = {};           // modes that the inertia had to resolve (dofs × count), where it had to
  EigenPairs lowest;                   // eigenpairs as far as they were asked for: where the search at a neighbour begins
  Vector soft_values = {};             // |μ| of the eigenvalues nearest to zero, roughly, where the next step asks for them
  EigenPairs softest = {};             // these eigenpairs, as see_softest() tells them, …
  Vector softening = {};               // … and dμ/dλ along the branch
  /// Nothing bears a force, and something may touch: what floats is pushed as far as it must, and what touches it may as well not.
  bool slack = false;
  /// Something that nothing holds is there and no contact bears a force, though other things may: it is pushed in the same way; and it touches something.
  bool floats = false, pushed = false;
  int family = 0;                      // most directions of a family of equilibria side by side that it may be one of; those that are nearly neutral are among zero_modes
};

/// Inertia, zero modes and their names, energies and tangent of a state that Newton has just converged to; of one at which it was interrupted the energies alone.
Equilibrium assess(Newton& newton, const State& state, const Report& report);

/// Tells the softest eigenpairs of an equilibrium that assess() or with_tangent() has just told, from those of a neighbour (none: from nothing), and how they
/// change from there to where the load factor is another by `change`:  dμ/dλ = vᵀ(dH/dλ)v.
void see_softest(Newton& newton, Equilibrium& e, const EigenPairs& neighbour, double change);

/// Follows the branch from one equilibrium to the load factor λ: tangent predictor, Newton's corrector or another one.
/// Converged only if it is on the same branch, as far as can be told; beyond a contact that is made on the way it cannot.
Equilibrium continue_to(Newton& newton, const Equilibrium& from, double load_factor, const Corrector& correct = {});

/// Whether two equilibria lie on one branch: what is between them is what the tangent at one end, at the other, or both
/// tell, but for a part (a branch that bends like a parabola into a limit point, from there to its vertex, has one half); and
/// where nothing touches, the tangents do not turn far, as they do over a pitchfork that is all but perfect. Two slack ones do.
[[nodiscard]] bool same_branch(Energy& energy, const Equilibrium& a, const Equilibrium& b);

/// Whether the branch through one equilibrium, as its tangent and Newton's method follow it with its zero modes held, leads to another one.
[[nodiscard]] bool leads_to(Newton& newton, const Equilibrium& from, const Equilibrium& to);

/// Whether no stable branch leads from one minimum to another: Π(x_b, λ_a) < Π(x_a, λ_a), by more than rounding. Along a stable branch under loads that grow
/// as the load factor does  d/dλ Π(x(λ), λ_a) = (λ − λ_a) x'ᵀ H x' ≥ 0,  with H x' = −∂g/∂λ; of what is driven so over steps that are short. False of what is
/// slack or pushed, whose energy is rounding.
[[nodiscard]] bool lower_already(Energy& energy, const Equilibrium& a, const Equilibrium& b);

/// How far from its place a state may be that Newton's method has come to [length]: ‖g‖/|μ|, with g what is left of the forces, which is rounding, and μ
/// the eigenvalue that is nearest to zero, but for held directions. 0: it cannot be told.
[[nodiscard]] double left_by_rounding(Newton& newton, const State& state, const Eigen::MatrixXd& held);

/// The motions of glued parts as rigid ones that no support forbids, orthonormal (dofs × count); none where there are more than six.
Eigen::MatrixXd free_motions(const Energy& energy, const State& state);

/// The columns of both, for what is held together.
Eigen::MatrixXd side_by_side(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Orthonormal modes of a multiple eigenvalue (dofs × count), turned so that their choice does not depend on rounding: the
/// first one follows x as much as the span can, else y, else z, and each has a positive sum or leading entry.
Eigen::MatrixXd canonical_modes(const Kinematics& kinematics, const Eigen::MatrixXd& modes);

}  // namespace elamin
