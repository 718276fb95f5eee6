#pragma once
// The parts of what paths are made of, for an Archive.
#include "model/carry.hpp"
#include "path/arc.hpp"
#include "path/event.hpp"

namespace elamin {

inline void carry(Archive& archive, EnergyTerms& x) {
  auto& [bond, angle, contact, wall, cohesion, body, external, own] = x;
  archive(bond, angle, contact, wall, cohesion, body, external, own);
}
inline void carry(Archive& archive, Iteration& x) {
  auto& [energy, residual, step, shift] = x;
  archive(energy, residual, step, shift);
}
inline void carry(Archive& archive, Report& x) {
  auto& [status, why, history, iterations, factorizations, evaluations, energy, residual, negative, seconds, factor_seconds] = x;
  archive(status, why, history, iterations, factorizations, evaluations, energy, residual, negative, seconds, factor_seconds);
}
inline void carry(Archive& archive, Stability& x) {
  auto& [negative, negative_rigid, zero, critical, zero_modes, stable] = x;
  archive(negative, negative_rigid, zero, critical, zero_modes, stable);
}
inline void carry(Archive& archive, Resume& x) {
  auto& [label, before, after, modes, tangent, direction, load, length, step, shortest, closed, closed_bodies] = x;
  archive(label, before, after, modes, tangent, direction, load, length, step, shortest, closed, closed_bodies);
}
inline void carry(Archive& archive, PathPoint& x) {
  auto& [step, label, branch, parent, state, energy, report, stability, multiplicity, negative_before, negative_after, modes, load_error, what, resume] = x;
  archive(step, label, branch, parent, state, energy, report, stability, multiplicity, negative_before, negative_after, modes, load_error, what, resume);
}
inline void carry(Archive& archive, EigenPairs& x) {
  auto& [values, vectors] = x;
  archive(values, vectors);
}
inline void carry(Archive& archive, RigidMotion& x) {
  auto& [name, translation, particle, sites, part_velocity, part, mid, size, twist] = x;
  archive(name, translation, particle, sites, part_velocity, part, mid, size, twist);
}
inline void carry(Archive& archive, Equilibrium& x) {
  auto& [point, tangent, zero_modes, motions, soft, lowest, soft_values, softest, softening, slack, floats, pushed, family] = x;
  archive(point, tangent, zero_modes, motions, soft, lowest, soft_values, softest, softening, slack, floats, pushed, family);
}
inline void carry(Archive& archive, ContactKey& x) {
  auto& [particle, other, wall, feature, within_cutoff] = x;
  archive(particle, other, wall, feature, within_cutoff);
}
inline void carry(Archive& archive, Event& x) {
  auto& [kind, at_parameter, at, modes, before, after, arrival, passing, passing_load, closed, beyond, onward, slides, what, user_event] = x;
  archive(kind, at_parameter, at, modes, before, after, arrival, passing, passing_load, closed, beyond, onward, slides, what, user_event);
}
inline void carry(Archive& archive, Metric& x) {
  auto& [length, load] = x;
  archive(length, load);
}
inline void carry(Archive& archive, Direction& x) {
  auto& [along, load] = x;
  archive(along, load);
}

}  // namespace elamin
