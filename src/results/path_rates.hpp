#pragma once
// How observables change along the path of equilibria that goes through a state.
#include "results/observables.hpp"
#include "solve/newton.hpp"

namespace elamin {

/// With the equilibrium x(λ) go its observables, dP/dλ = ∂P/∂λ + ∂P/∂x·dx/dλ. The tangent is that of the path, K dx/dλ = −∂g/∂λ with the
/// prescribed coordinates at their rates, motions that cost nothing held, hard contacts kept closed by forces that change; no other point of the
/// path is asked for. Along the tangent P is differentiated by central differences of halved steps, extrapolated: about nine digits.
/// At a limit point dx/dλ is infinite: there the tangent is the null vector of K, and dλ = 0. Where the path has more than one, at a branch
/// point, or a corner, where a hard contact or one of a body is made or lost, there are no rates.
/// Source: Ridders 1982, Adv. Eng. Software 4, 75 (differences).
class PathRates {
 public:
  /// Of these [[observe]]s; see Probe.
  PathRates(const Problem& problem, const Model& model, const std::vector<std::size_t>& numbers)
      : probe_(problem, model, numbers), newton_(probe_.energy()) {}

  const std::vector<ObserveTable>& observed() const { return probe_.observed(); }

  /// Rates of change along the tangent: of λ, then of each observable; not finite where there is none. By λ: over the first.
  std::vector<double> at(const State& state);

 private:
  struct Tangent {
    Vector q, force;                   // of the free dofs [length], of the hard contacts
    double load = 0;                   // dλ
  };
  bool corner(const State& state);
  std::optional<Tangent> tangent(const State& state);
  struct Steps { double longest; int halvings; };
  Steps steps(const State& state, const Tangent& tangent);

  Probe probe_;
  Newton newton_;
};

}  // namespace elamin
