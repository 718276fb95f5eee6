#pragma once
// Structures that stay in a plane.
#include "lammps/script/particles.hpp"

namespace elamin::script {

/// The coordinate that all particles have alike and that nothing moves them along, or −1.
int flat(const World& world, const Particles& particles);

}  // namespace elamin::script
