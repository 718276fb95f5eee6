#pragma once
// Newton's equations of motion, step by step.
#include "core/archive.hpp"
#include "dynamics/motion.hpp"

#include <memory>

namespace elamin {

/// A model at rest or in motion as it is given: its restart or start, its velocities and, where friction acts, spins; at
/// that load factor. Forces, work and dissipation are zero.
Motion begin_motion(const Model& model);

/// Velocity Verlet, as LAMMPS has it with fix nve/sphere and fix move linear. One step of dt:
///   v += dt/2 f/m,   x += dt v;   held coordinates: x = x(0) + V (steps · dt), v = V, without a velocity V = 0
///   f = −∂U/∂x at the new x, drag −γ v, damping and friction of contacts, with these half-step velocities and angular velocities
///   v += dt/2 f/m;   where friction acts  ω likewise with the torques, I = 2/5 m r², of particles that are not held whole
/// All conditions act as they do at the load factor of the start; walls stand still. Of order two in dt but for what
/// depends on velocities, which is taken half a step too early: of order one in γ dt/m.
/// work: ∫ −F·V dt over the driven coordinates; dissipation: ∫ −D·v + … dt with the forces and torques D of drag, damping
/// and friction; both by the trapezoidal rule at whole steps, so that kinetic + potential + dissipation − work is constant to
/// O(dt²). Motion::force holds every force of the moment on every particle, held or not.
/// Bodies: as LAMMPS's fix nve/body, see MovingBodies; F and T of everything that acts on them and on what they carry, whose mass and inertia
/// they have besides their own (balls of density · π d³/6). A body is held or driven in its place as particles are; a held turn stays.
/// Pairs and walls that follow LAMMPS's rules act with their damping, which is counted as dissipation; their elastic forces need not
/// have an energy, so that then nothing balances.
/// One thread; the same bits however the steps are divided among calls. Who takes up a copy of motion() goes on with its
/// step, time, work and dissipation; x(0) is where that one starts, and contacts may be summed in another order; where a body carries
/// mass its centre of mass is formed anew.
class Verlet {
 public:
  /// Throws InputError where something that can move has no mass, a contact is hard, or a body that carries mass is held in a way that
  /// needs more than this: see MovingBodies::mistakes.
  Verlet(const Model& model, Motion start, double timestep);
  ~Verlet();
  Verlet(Verlet&&) noexcept;

  /// Goes on by so many steps; returns how many were taken. Fewer: it was interrupted, or finite() no longer holds.
  std::int64_t advance(std::int64_t steps);
  /// Whether every position is still a number; looked at every few steps.
  bool finite() const;
  const Motion& motion() const;
  double timestep() const;
  /// Σ ½ m v² + ½ I ω² (spins: of bodies, and where friction acts) [energy].
  double kinetic() const;
  /// All that goes on from step to step. One made of the same start that reads it goes on with the same bits.
  void carry(Archive& archive);

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace elamin
