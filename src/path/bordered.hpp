#pragma once
// The corrector with the load factor free: equilibria on a hyperplane across the branch.
#include "path/equilibrium.hpp"

namespace elamin {

/// Steps of pseudo-arc length s from one equilibrium:  g(x, λ) = 0,  w t_x·(x − x₀) + t_λ (λ − λ₀) = s  with the unit
/// tangent (t_x, t_λ) in the norm |(x, λ)|² = w|x|² + λ², w = 1/|dx/dλ|².  Keller 1977.
class ArcStep {
 public:
  /// direction: +1 towards larger load factors, −1 towards smaller ones.
  ArcStep(Energy& energy, const Equilibrium& from, int direction);
  /// The equilibrium at arc length s; not converged if Newton does not contract there.
  Equilibrium equilibrium(Newton& newton, double s) const;

 private:
  Energy& energy_;
  Equilibrium from_;
  double weight_, t_lambda_;
  Vector t_x_;
};

}  // namespace elamin
