#pragma once
// The branch up to where a contact is lost, by what is left of the contact.
#include "path/contact_gap.hpp"
#include "path/segment.hpp"

namespace elamin {

/// The branch from an equilibrium to where the overlap δ of one of its contacts vanishes, over t = −√(δ/δ₀) from −1 to 0, δ₀ being the overlap where it begins: t is in
/// proportion to the stiffness of Hertz's contact. Where a contact much stiffer than what it presses on is all that keeps the structure stable, its stiffness fades,
/// and the load factor turns, in a part of the way that no step of arc length meets; over t the branch is smooth there.
/// load_change: the scale of the load factor.
Segment segment_of_fading(Newton& newton, const ContactKey& key, const Equilibrium& from, double load_change);

}  // namespace elamin
