#pragma once
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace elamin {

/// Energies by term [energy]; contact: Hertz between particles, wall: at walls, cohesion: Lennard-Jones; body: between rounded
/// bodies, and of them with particles;
/// external = −Σ F·x of all loads and weights and Σ p A of the pressures at the load factor in force.
struct EnergyTerms {
  double bond = 0, angle = 0, contact = 0, wall = 0, cohesion = 0, body = 0, external = 0;
  std::vector<std::pair<std::string, double>> own;      // of groups that a program adds (Energy::add)

  /// The terms that every energy has, in the order of columns and files.
  static constexpr std::array<std::pair<const char*, double EnergyTerms::*>, 7> known();
  /// Calls use(name, value) for every term.
  template <class Use>
  void for_each(const Use& use) const {
    for (const auto& [name, term] : known()) use(name, this->*term);
    for (const auto& [name, value] : own) use(name, value);
  }
  double total() const {
    double sum = 0;
    for_each([&](const auto&, double value) { sum += value; });
    return sum;
  }
  /// Sum of the terms' sizes: ε times it is what rounding does to the total.
  double size() const {
    double sum = 0;
    for_each([&](const auto&, double value) { sum += std::abs(value); });
    return sum;
  }
};

constexpr std::array<std::pair<const char*, double EnergyTerms::*>, 7> EnergyTerms::known() {
  return {{{"bond", &EnergyTerms::bond}, {"angle", &EnergyTerms::angle}, {"contact", &EnergyTerms::contact}, {"wall", &EnergyTerms::wall},
           {"cohesion", &EnergyTerms::cohesion}, {"body", &EnergyTerms::body}, {"external", &EnergyTerms::external}}};
}

/// "energy", the sum, and the names of the terms: columns of tables.
inline std::vector<std::string> energy_columns() {
  std::vector<std::string> columns{"energy"};
  for (const auto& [name, term] : EnergyTerms::known()) columns.emplace_back(name);
  return columns;
}

}  // namespace elamin
