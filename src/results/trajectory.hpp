#pragma once
// A motion as rows of trajectory.csv and frames.
#include "dynamics/motion.hpp"
#include "energy/terms.hpp"
#include "results/table.hpp"

#include <string>
#include <vector>

namespace elamin {

/// One moment of a motion; label "" or "initial" or "final".
struct Moment {
  std::string label;
  Motion motion;
  EnergyTerms energy;                  // potential energies
  double kinetic = 0;                  // of translation and of rotation
};

/// step, label, time, energy (potential, all of it), bond, angle, contact, wall, cohesion, body, external, kinetic, work (of driven
/// supports so far), dissipation (by drag, damping and friction so far), balance = energy + kinetic + dissipation − work,
/// which does not change but for the error of the time step; then the observables.
std::vector<std::string> trajectory_columns(const std::vector<std::string>& observables);
Row trajectory_row(const Moment& moment, const std::vector<double>& observables);

/// frames/STEP.csv: id, x, y, z, vx, vy, vz, fx, fy, fz of all particles; and of bodies, if there are any, STEP.bodies.csv: id,
/// place, unit quaternion qw ≥ 0, qx, qy, qz, velocity, angular momentum L, force, torque about the place t; of bodies of a LAMMPS
/// data file the quaternion is the turn from there. Throws OutputError if it cannot be written.
void write_frame(const std::string& file, const Model& model, const Motion& motion);

}  // namespace elamin
