#pragma once
// Where between two equilibria a contact is made or lost.
#include "path/segment.hpp"

#include <optional>
#include <set>
#include <string>

namespace elamin {

/// Two particles (wall −1), or a particle at a wall (other −1).
struct ContactKey {
  int particle, other, wall;
  auto operator<=>(const ContactKey&) const = default;
};
using ContactSet = std::set<ContactKey>;

/// The contacts whose surfaces overlap at the state.
ContactSet closed_contacts(Energy& energy, const State& state);

struct ContactChange {
  bool found = false;                  // else: something changes, but an equilibrium between could not be computed
  double at_parameter = 0;
  Equilibrium at;
  ContactSet after;                    // what is closed beyond
  std::string what;                    // who touches or leaves whom
};

/// The first change of the closed contacts on a segment from `a` to `b`, located at the zero of the gap that changes sign,
/// to rounding. `before`: what is closed from `a` on, which at an event differs from what overlaps at `a` itself.
/// Contacts that change together are one event. Nothing if none changes.
std::optional<ContactChange> locate_contact(Newton& newton, const Segment& segment, const ContactSet& before, const Equilibrium& a,
                                            const Equilibrium& b);

}  // namespace elamin
