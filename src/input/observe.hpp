#pragma once
// What is observed and expected.
#include "input/keys.hpp"


namespace elamin {

enum class Quantity {
  position, displacement, rotation, reaction, torque, velocity, angular_velocity, gap, contacts,     // of particles and bodies
  contact_force, energy,
  tension, strain,                                                                       // of bonds
  moment, curvature,                                                                     // at angles
  membrane_force, bending_moment,                                                             // of sheets
  distance, angle, slope, extent, end_to_end, area,                                      // of a shape
  difference, derivative                                                                 // of other observables
};
enum class Component { x, y, z, norm, c11, c22, c12, most, least };
enum class Reduce { mean, sum, min, max };
enum class RowEnd { first, last };

struct ObserveTable {
  TablePlace place;
  std::string name, group;                      // the group may be a wall
  Quantity quantity = Quantity::position;
  Component component = Component::x;           // not of what is a number
  Reduce reduce = Reduce::mean;
  std::string to, through;                      // distance, angle: other groups
  std::optional<Vec3> axis, about;              // angle, slope
  RowEnd end = RowEnd::last;                    // slope
  std::vector<std::string> of;                  // difference, derivative: other observables …
  std::string by = "lambda";                    // … or the load factor
  bool operator==(const ObserveTable&) const = default;
};

struct ExpectTable {
  TablePlace place;
  std::string observable, at = "final";
  double value = 0;
  double rtol = 1e-8, atol = 0;
  std::string source;
  std::optional<int> extrapolate;
  bool continuum = false;                       // of [refine]: the value without particles …
  std::optional<double> bar;                    // … and how wide its error may be
  bool operator==(const ExpectTable&) const = default;
};

void describe(Keys& keys, ObserveTable& t);
void describe(Keys& keys, ExpectTable& t);

/// Quantities that are made of other observables; that a group has as a whole, by its shape; those of which it has many, that are reduced.
constexpr bool of_observables(Quantity q) { return q == Quantity::difference || q == Quantity::derivative; }
constexpr bool of_shape(Quantity q) { return q >= Quantity::distance && q <= Quantity::area; }
constexpr bool is_reduced(Quantity q) { return q < Quantity::distance; }
/// Those of a group as a row of particles: how many it must have at least, or 0.
constexpr std::size_t least_row(Quantity q) { return q == Quantity::area ? 3 : q == Quantity::slope || q == Quantity::end_to_end ? 2 : 0; }
/// Quantities of what is inside: bonds, angles, sheets.
constexpr bool of_bonds(Quantity q) { return q == Quantity::tension || q == Quantity::strain; }
constexpr bool of_angles(Quantity q) { return q == Quantity::moment || q == Quantity::curvature; }
constexpr bool of_sheets(Quantity q) { return q == Quantity::membrane_force || q == Quantity::bending_moment; }

/// How the values of a group become one where the file does not say it.
constexpr Reduce default_reduce(Quantity q) {
  if (q == Quantity::gap) return Reduce::min;
  for (const Quantity summed : {Quantity::reaction, Quantity::torque, Quantity::contacts, Quantity::contact_force, Quantity::energy})
    if (q == summed) return Reduce::sum;
  return Reduce::mean;
}

/// The numbers of the observables that one is made of, each before those made of it, itself last.
std::vector<std::size_t> made_of(const std::vector<ObserveTable>& all, std::size_t number);

}  // namespace elamin
