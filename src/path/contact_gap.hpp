#pragma once
// The gap of one contact as a function of the state and the load factor.
#include "energy/energy.hpp"

#include <compare>
#include <set>

namespace elamin {

/// Two entities (wall −1), or one at a wall (other −1); of bodies each place where they may touch, see TouchKey.
struct ContactKey {
  int particle, other, wall;
  int feature = -1;
  bool within_cutoff = false;                  // bodies that attract each other: within the cutoff, whether they overlap or not
  auto operator<=>(const ContactKey&) const = default;
};
using ContactSet = std::set<ContactKey>;

inline TouchKey touch_key(const ContactKey& key) { return {key.particle, key.other, key.wall, key.feature}; }

/// The gap at a state, below zero where surfaces overlap [length]; of an attraction the distance beyond its cutoff. Infinite where bodies have no such place.
double gap(const Energy& energy, const ContactKey& key, const State& state);

/// By how much the gap of a wall may be wrong, which stands where coordinates are rounded [length]; those of particles are exact.
double coordinate_rounding(const ContactKey& key, const State& state);

/// ∇gap (dofs) and ∂gap/∂λ of prescribed coordinates and moving walls; load_change: over which the walls move. False where there is none.
[[nodiscard]] bool slope(const Energy& energy, const ContactKey& key, const State& state, double load_change, Vector& row, double& by_load);

/// What a contact bears at an equilibrium, in parts of the largest force there; less than 0 where it is open.
double borne(Energy& energy, const ContactKey& key, const State& state);
/// The same of what is known to touch there, which what does not may be among.
double borne(const Energy& energy, const ContactKey& key, const std::vector<Touch>& touches);

/// A state moved by a part of a way (dofs), prescribed coordinates by their part of the change of the load factor.
State moved_by(const Kinematics& kinematics, const State& from, const Vector& way, double load_change, double part);

}  // namespace elamin
