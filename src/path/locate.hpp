#pragma once
// Where between two equilibria an eigenvalue crosses zero: branch points and limit points.
#include "path/equilibrium.hpp"

#include <optional>

namespace elamin {

/// An equilibrium at which the Hessian is singular, located to rounding, with its critical modes (dofs × multiplicity).
struct Event {
  EventKind kind = EventKind::branch;
  Equilibrium at;
  Eigen::MatrixXd modes;
};

/// The first change of the Morse index between two equilibria of one branch, by root finding (Illinois, bracketed) on
/// the sorted eigenvalue that changes sign, at equilibria that the corrector itself computes.
/// Nothing if that eigenvalue does not go through zero: then `b` is on another branch than `a`.
std::optional<Event> locate_crossing(Newton& newton, const Equilibrium& a, const Equilibrium& b);

/// The limit point that stops load steps behind `a`: steps in arc length
///   w t_x·(x − x̂) + t_λ (λ − λ̂) = 0,   w = 1/|dx/dλ|²,
/// until the lowest positive eigenvalue changes sign, then root finding in the arc length. `reach`: the load factor that
/// could not be got to. Nothing if no eigenvalue changes sign within the steps tried.
std::optional<Event> locate_limit(Newton& newton, const Equilibrium& a, double reach);

}  // namespace elamin
