#include "input/motion.hpp"

namespace elamin {

void describe(Keys& keys, ViscosityTable& t) {
  keys.about("A force −coefficient · velocity, as LAMMPS's fix viscous; on bodies a torque likewise.");
  keys.may("group", t.group, "what it acts on");
  keys.must("coefficient", t.coefficient, "[force·time/length]", range::not_negative);
}

void describe(Keys& keys, VelocityTable& t) {
  keys.about("Velocity at the start of a motion; what is held moves as its support says.");
  keys.may("group", t.group, "what has it");
  keys.may("velocity", t.velocity, "of every particle and body [length/time]");
  keys.may("angular_velocity", t.angular_velocity, "angular velocity of bodies [1/time]");
}

void describe(Keys& keys, DynamicsTable& t) {
  keys.about("Velocity Verlet in time, or damped dynamics (FIRE) to an equilibrium.");
  keys.may("relax", t.relax, "damped, to an equilibrium");
  keys.may("timestep", t.timestep, "[time]; needed, but by relax, which chooses its own", range::positive);
  keys.may("steps", t.steps, "how many, of relax at most", Range{0, 2e9});
  keys.may("every", t.every, "steps between rows of trajectory.csv", range::id);
  keys.may("record", t.record, "steps whose frames are written; by default each `every`", Range{0, 2e9});
  keys.words("film", t.film, film_words, "files that show these frames: for LAMMPS and OVITO, for ParaView, extended XYZ");
  keys.may("allow_unstable", t.allow_unstable, "a timestep beyond the stable limit");
}

}  // namespace elamin
