#pragma once
// How far a step may go before something would pass through something else.
#include "energy/body_rules.hpp"
#include "energy/neighbours.hpp"

namespace elamin {

/// Largest s in [0, 1] so that on the straight way from → to, up to s, no two particles that feel each other come nearer
/// than 0.8 min(r, ρ), r their distance at `from`, ρ the distance of touch, and no particle's centre comes nearer to a wall
/// it feels than 0.8 min(d, radius), d its distance at `from`. Walls move with the load factor. So overlaps grow by a
/// fifth of their bound at most, and nothing is on the other side of anything afterwards.
/// Pairs: exact, from the smaller root of |x_ij + s u_ij| = floor. Walls: conservative advancement, as the distance to a
/// surface changes no faster than the particle moves (Mirtich 1996). Of a step longer than a thousand of the smallest distances
/// of touch only so much is looked at, and no more is free. 0: a centre lies on a wall and would go through it.
double collision_free_particle_step(const Model& model, const Neighbours& neighbours, const State& from, const State& to);

/// Largest s in [0, 1] so that on the way from → to, up to s, no core of a body comes nearer to another core, a particle's
/// centre or a wall it feels than a fifth of its distance at `from`. Cores that overlap at `from` are no bar. Conservative
/// advancement: a distance d lasts for s = d/v, v no less than any speed of approach,
///   v = |Δx_A − Δx_B| + |Δφ_A| extent_A + |Δφ_B| extent_B   (Mirtich 1996). 0 where it is interrupted.
double collision_free_body_step(const Model& model, const BodyRules& rules, const State& from, const State& to);

}  // namespace elamin
