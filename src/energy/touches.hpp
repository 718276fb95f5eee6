#pragma once
#include "energy/body_rules.hpp"
#include "energy/neighbours.hpp"
#include "energy/touch.hpp"

namespace elamin {

/// Every contact that is closed, and every one whose gap is at most `within` [length; may be infinite: all pairs that have
/// a table are looked at then]: pairs in ascending order of entities, then wall after wall, entity after entity. Of bodies
/// also what attracts: see body_touches.hpp.
std::vector<Touch> find_touches(const Model& model, const Neighbours& neighbours, const BodyRules& body_rules, const State& state, double within);

/// Distance of the surfaces of two particles, and of a particle and the nearest face of a wall (infinity: the wall does not
/// see it); negative: overlap. [length]
double pair_gap(const Model& model, int i, int j, const State& state);
double wall_gap(const Model& model, int particle, int wall, const State& state);

}  // namespace elamin
