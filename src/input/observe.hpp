#pragma once
// What is observed and expected.
#include "input/keys.hpp"


namespace elamin {

enum class Quantity { position, displacement, rotation, reaction, torque, velocity, spin, gap, contacts };
enum class Component { x, y, z, norm };
enum class Reduce { mean, sum, min, max };

struct ObserveTable {
  TablePlace place;
  std::string name, group;                      // the group may be a wall
  Quantity quantity = Quantity::position;
  Component component = Component::x;           // not of a gap and of contacts
  Reduce reduce = Reduce::mean;
  bool operator==(const ObserveTable&) const = default;
};

struct ExpectTable {
  TablePlace place;
  std::string observable, at = "final";
  double value = 0;
  double rtol = 1e-8, atol = 0;
  std::string source;
  std::optional<int> extrapolate;
  bool operator==(const ExpectTable&) const = default;
};

void describe(Keys& keys, ObserveTable& t);
void describe(Keys& keys, ExpectTable& t);

/// How the values of a group's particles become one where the file does not say it.
constexpr Reduce default_reduce(Quantity q) {
  if (q == Quantity::gap) return Reduce::min;
  return q == Quantity::reaction || q == Quantity::torque || q == Quantity::contacts ? Reduce::sum : Reduce::mean;
}

}  // namespace elamin
