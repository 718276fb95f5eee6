#pragma once
// Structures that stay in a plane.
#include "lammps/script/particles.hpp"

namespace elamin::script {

/// The coordinate that all particles have alike and that nothing moves them along, in the first `runs` runs, or always.
struct Flat {
  int direction = -1;                           // −1: there is none
  int runs = 0;
  bool always = false;
};
Flat flat(const World& world, const Particles& particles);

}  // namespace elamin::script
