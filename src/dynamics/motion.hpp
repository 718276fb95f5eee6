#pragma once
// What moves: where everything is, how fast, and what has been put in and taken out.
#include "laws/rounded/rigid_step.hpp"
#include "model/model.hpp"

namespace elamin {

struct Motion {
  State state;
  Field velocity;                      // 3 × particles [length/time]
  Field angular_velocity;              // 3 × particles; empty where nothing turns particles
  Field force;                         // on every particle, held or not, drag and damping included: 3 × particles [force]
  Field body_velocity, angular_momentum;   // of bodies, axes of space, 3 × bodies
  Field body_force, torque;            // on every body, held or not, damping included; torque about its position: 3 × bodies
  std::int64_t step = 0;
  double time = 0;
  double work = 0;                     // done by driven supports so far [energy]
  double dissipation = 0;              // by drag, damping and friction so far [energy]
};

class Kinematics;
/// Throws InputError where something that can move has no mass, a contact is hard, or bodies cannot move as they are held.
void refuse_what_cannot_move(const Model& model, const Kinematics& kinematics);

}  // namespace elamin
