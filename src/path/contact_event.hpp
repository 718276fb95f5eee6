#pragma once
// Where between two equilibria a contact is made or lost.
#include "path/beside_contact.hpp"
#include "path/segment.hpp"

#include <optional>

namespace elamin {

/// Contacts that are in one of two sets, but not in both.
ContactSet difference(const ContactSet& a, const ContactSet& b);

/// The contacts whose surfaces overlap at the state, or are nearer than `within` [length], and which bodies are within the cutoff of an attraction.
ContactSet closed_contacts(Energy& energy, const State& state, double within = 0);
/// The same of an equilibrium; of a slack one those that just touch as well.
ContactSet closed_contacts(Energy& energy, const Equilibrium& e);

/// The first change of the closed contacts on a segment from `a` to `b`, located at the zero of the gap that changes sign,
/// to rounding. `before`: what is closed from `a` on, which at an event differs from what overlaps at `a` itself.
/// Contacts that change together are one event. Nothing if none changes.
[[nodiscard]] std::optional<ContactChange> locate_contact(Newton& newton, const Segment& segment, const ContactSet& before, const Equilibrium& a,
                                            const Equilibrium& b);

/// Where on a segment a contact may be made and lost, or lost and made, which is open, or closed, at both ends: the parameter at which Hermite's cubic of its gap,
/// with the rates that the tangents tell, is farthest on the other side, of the one that goes farthest; `but`: not looked at. Nothing if no gap gets there.
[[nodiscard]] std::optional<double> where_contact_may_pass(Energy& energy, const Segment& segment, const Equilibrium& a, const Equilibrium& b, const ContactSet& but);

/// A kink that is ahead: the equilibrium at which the first contact changes on the way along the tangent of `a`, up to the
/// part 1 of the way (dofs) and change of the load factor, found without equilibria beyond, of which there may be none: by
/// Newton's method on ∇gap · Δx = 0, again and again. `before` as above; `made`: whether contacts that are made are looked for, too. Nothing if there is none.
[[nodiscard]] std::optional<ContactChange> kink_ahead(Newton& newton, const ContactSet& before, const Equilibrium& a, const Vector& way, double load_change, bool made = true);

/// Whether the gap of a contact is none at a state, to contact_event::together of the size, whether its surfaces overlap by that or are apart.
[[nodiscard]] bool just_touches(const Energy& energy, const ContactKey& key, const State& state);

/// Those of the closed contacts that just touch: made where the state is, or next to rigid.
std::vector<ContactKey> just_touching(const Energy& energy, const State& state, const ContactSet& closed);

}  // namespace elamin
