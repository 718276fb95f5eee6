#pragma once
// A piece of a branch between two equilibria as a function of one parameter: load factor, or arc length.
#include "path/equilibrium.hpp"

#include <functional>

namespace elamin {

struct Segment {
  double a = 0, b = 0;                 // parameters of its ends
  /// The equilibrium at a parameter between, computed from one that is near; not converged if there is none to be had.
  std::function<Equilibrium(double parameter, const Equilibrium& nearest)> at;
};

}  // namespace elamin
