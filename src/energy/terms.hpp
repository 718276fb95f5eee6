#pragma once

namespace elamin {

/// Energies by term [energy]; external = −Σ F·x of all loads and weights at the load factor in force.
struct EnergyTerms {
  double bond = 0, angle = 0, external = 0;
  double total() const { return bond + angle + external; }
};

}  // namespace elamin
