#pragma once
// How far a step may go before a rigid body would pass into something else.
#include "energy/body_rules.hpp"

namespace elamin {

/// Largest s in [0, 1] so that on the way from → to, up to s, no core of a body comes nearer to another core, a particle's
/// centre or a wall it feels than a fifth of its distance at `from`. Cores that overlap at `from` are no bar. Conservative
/// advancement: a distance d lasts for s = d/v, v no less than any speed of approach,
///   v = |Δx_A − Δx_B| + |Δφ_A| extent_A + |Δφ_B| extent_B   (Mirtich 1996). 0 where it is interrupted.
double collision_free_body_step(const Model& model, const BodyRules& rules, const State& from, const State& to);

}  // namespace elamin
