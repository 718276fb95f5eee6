#pragma once
// Equilibria side by side at the same load factor, as those of an oval that may lie in any direction in its ring: what is held while one of them stands for all.
#include "path/contact_gap.hpp"
#include "path/equilibrium.hpp"

namespace elamin {

/// Eigenpairs of the Hessian whose stiffness is next to nothing beside the next one, at most `count` of them: as of an oval that rotates in a ring of links.
[[nodiscard]] EigenPairs nearly_neutral(Newton& newton, const Equilibrium& e, int count);

/// Takes up to `count` nearly neutral modes of an equilibrium among its zero modes, those that are alike to `before` (dofs × m; none: any): a family of
/// equilibria may cost a little to move along, as a polygon's does that stands for a ring.
void take_nearly_neutral(Newton& newton, Equilibrium& e, int count, const Eigen::MatrixXd& before);

/// The same for an equilibrium that assess() has just told, which may be one of a family: what is neutral is called so, and its tangent is along no such direction.
void hold_family(Newton& newton, Equilibrium& e, int count, const Eigen::MatrixXd& before = {});

/// Names zero modes that last along a branch and are no motions of rigid parts.
void name_neutral(Stability& s);

/// Directions to hold instead of neutral modes (dofs × count), so that a family of equilibria is traced where its symmetry keeps it. In a plane
/// they are those of ∇c,  c = Σ_k q_k ω_k,  ω_k the angles' changes and q_k those that the mode makes, which supports do not enter: with
/// them a symmetric change of shape comes together with a rigid motion, and has a part along the mode. Of rigid motions, and in space, the
/// modes themselves. Orthonormal.
Eigen::MatrixXd phase_conditions(const Energy& energy, const State& state, const Eigen::MatrixXd& modes);

/// Corrects a state beside an equilibrium with these conditions held, and shifts it along the neutral modes until c is what it was: an oval
/// does not slide along its ring. `correct` is called again after each shift.
[[nodiscard]] Report correct_in_phase(const Energy& energy, const Equilibrium& from, State& state,
                        const std::function<Report(State&, const Eigen::MatrixXd& held)>& correct);

/// canonical_modes() for the modes of an event. Two of them in a plane: the second is the one that leaves a single angle as it is, of the angles that
/// others bend most the first, so that where a ring buckles it is antisymmetric about a particle.
Eigen::MatrixXd symmetric_modes(const Energy& energy, const State& state, const Eigen::MatrixXd& modes);

/// Of such modes the direction that is symmetric about the same particle: it bends angles in a way that is orthogonal to that of the second
/// mode. (Displacements, which supports choose, tell it not.) Of others the first.
Vector symmetric_direction(const Energy& energy, const State& state, const Eigen::MatrixXd& modes);

/// Moves an equilibrium of a family of one direction in a plane along it, downhill, to where no force acts any more: a polygon that stands for a ring holds an oval
/// a little, in 2N directions of its N links. False, and nothing moves, where that force is rounding, or no such place is found.
bool rest_in_family(Newton& newton, Equilibrium& e);

/// Moves an equilibrium of a family of one direction along it, away from what it touches without a force, as far as the least gap grows: a column that slides along
/// a wall would come to it again on the next step. False, and nothing moves, where it touches nothing in that way.
bool move_from_contacts(Newton& newton, Equilibrium& e);

/// Whether these gaps change along the mode of a family.
bool opens_along(const Energy& energy, const Equilibrium& e, const ContactSet& contacts);

}  // namespace elamin
