#pragma once
// Walks at one load factor: uphill to a saddle, downhill to a minimum, and paths between two minima.
#include "path/equilibrium.hpp"

namespace elamin {

/// The lowest eigenpairs in the space orthogonal to `held` (as many of `count` as there are), at a state that is evaluated here; near: vectors
/// that may be near, or none.
EigenPairs soft_modes(Newton& newton, const State& state, const Eigen::MatrixXd& held, int count, const Eigen::MatrixXd& near = {});

/// Where a walk goes (dofs each; empty: none): `first` is its first step, sign as given; along `up`, and what that becomes, the energy is a maximum
/// at its end, along all else a minimum.
struct Heading { Vector first, up; };

/// The equilibrium that a walk comes to; nothing where it comes to none. With soft modes vᵢ, their stiffnesses κᵢ and slopes cᵢ = vᵢᵀg it takes
/// the steps
///   Δx = Σ ∓(cᵢ/|κᵢ|) vᵢ,  − of all modes but that which it climbs along; where that one is stiff (κ > 0) as far up as a step may go,
/// and after each of them the rest of the structure relaxes with the vᵢ held, so that a step that turns bonds does not stretch them. No step turns
/// what is glued by more than a radius, which shrinks where slopes do not change as κᵢ tells, and downhill where the energy does not fall: a walk
/// does not leap over what is in between. Downhill it is the steepest descent in the metric |H|. It ends where gradient and steps vanish, which may
/// be at an equilibrium of another index where symmetry keeps it so: look at its index. Sources: Cerjan & Miller 1981, J. Chem. Phys. 75, 2800
/// (eigenvectors uphill); Dauphin et al. 2014, NIPS 27 (|H|); Yin, Zhang, Zhang 2019, SIAM J. Sci. Comput. 41, A3576 (from saddles of higher
/// index down to those of lower).
[[nodiscard]] std::optional<Equilibrium> walk(Newton& newton, State state, const Heading& heading, const Eigen::MatrixXd& held);

/// Equilibria on the way between two states: states on a line from one to the other relax in the planes across it, by Newton's steps with H + τI,
/// and are set evenly again, and from each one whose energy is a maximum among its neighbours a walk climbs along the line. Source: E, Ren,
/// Vanden-Eijnden 2007, J. Chem. Phys. 126, 164103, with Newton's steps for those down the gradient.
[[nodiscard]] std::vector<Equilibrium> passes_between(Newton& newton, const State& a, const State& b, const Eigen::MatrixXd& held);

}  // namespace elamin
