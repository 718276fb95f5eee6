#pragma once
// Where rounded bodies touch each other, particles and walls.
#include "energy/body_rules.hpp"
#include "energy/touch.hpp"

#include <optional>

namespace elamin {

/// Every contact with a body in it that is closed, that attracts, or whose gap is at most `within` [length; may be infinite],
/// appended: one a term of the potential in force. The force is weight · U′ along the normal; what the change of the weight of
/// a term adds, at corners only, is left out. Where LAMMPS's rules hold there is none. The `feature` of a TouchKey:
///   a wall: 8 · vertex + face        closest: 0
///   multi: 3 · vertex of the first, 3 · vertex of the second + 1, 3 · (edge of the first · edges of the second + edge) + 2
void add_body_touches(const Model& model, const BodyRules& rules, const State& state, double within, std::vector<Touch>& touches);

/// One of them at any state, near or far: its gap, point and normal, without force. Nothing where it is no contact: two edges
/// whose common perpendicular lies beyond their ends, a vertex outside of a region.
[[nodiscard]] std::optional<Touch> body_touch(const Model& model, const BodyRules& rules, const TouchKey& key, const State& state);

/// r_c of the table or wall of a contact with a body in it where it attracts, else 0. [length]
double attraction_range(const Model& model, const BodyRules& rules, const TouchKey& key);

}  // namespace elamin
