#pragma once
#include <cmath>

namespace elamin {

/// Energies by term [energy]; contact: Hertz between particles, wall: at walls, cohesion: Lennard-Jones; body: between rounded
/// bodies, and of them with particles;
/// external = −Σ F·x of all loads and weights and Σ p A of the pressures at the load factor in force.
struct EnergyTerms {
  double bond = 0, angle = 0, contact = 0, wall = 0, cohesion = 0, body = 0, external = 0;
  double total() const { return bond + angle + contact + wall + cohesion + body + external; }
  /// Sum of the terms' sizes: ε times it is what rounding does to the total.
  double size() const {
    return std::abs(bond) + std::abs(angle) + std::abs(contact) + std::abs(wall) + std::abs(cohesion) + std::abs(body) + std::abs(external);
  }
};

}  // namespace elamin
