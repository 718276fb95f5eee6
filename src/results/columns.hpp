#pragma once
// The columns of path.csv, events.csv and sweep.csv, and how a point of a path becomes a row of them.
#include "dynamics/motion.hpp"
#include "energy/terms.hpp"
#include "input/problem.hpp"
#include "model/model.hpp"
#include "path/point.hpp"
#include "results/table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// The names of every [[observe]], and behind them eigenvalue_1 … as many as the study has, and the terms of a program's own laws.
std::vector<std::string> observable_columns(const Problem& problem, const std::vector<OwnLaw>& own = {});

/// The columns of the table of a run: of path.csv, or of trajectory.csv.
std::vector<std::string> run_columns(const Problem& problem, const std::vector<OwnLaw>& own = {});

/// What a row of landscape.csv begins with.
std::vector<std::string> node_columns(const std::vector<std::string>& observables);
Row node_row(const PathPoint& p, const std::vector<double>& observables);

/// step, label, branch, lambda, energy, bond, angle, contact, wall, cohesion, body, external, residual, iterations, negative,
/// stable, then the observables, parent, negative_rigid, and `stage` of a path in stages.
std::vector<std::string> path_columns(const std::vector<std::string>& observables, bool staged = false);
/// stage: of a path in stages, the name of the point's.
Row path_row(const PathPoint& point, const std::vector<double>& observables, const std::optional<std::string>& stage = std::nullopt);

/// label, lambda, multiplicity, then the columns of path.csv without label and lambda, with negative_before,
/// negative_after, what and, if asked for, lambda_error (of the load factor, by rounding) behind negative_rigid.
std::vector<std::string> event_columns(const std::vector<std::string>& observables, bool staged = false, bool errors = false);
Row event_row(const PathPoint& point, const std::vector<double>& observables,
              const std::optional<std::string>& stage = std::nullopt, bool errors = false);

/// second, label, lambda, then the columns of path.csv behind these, multiplicity, asymmetry and what: those of curve.csv.
std::vector<std::string> curve_columns(const std::vector<std::string>& observables);
Row curve_row(double second, double asymmetry, const PathPoint& point, const std::vector<double>& observables);

/// An event's label has a colon and a number, as in "branch:1"; "initial" and "final" are no events.
bool is_event(const std::string& label);

/// The swept keys, status, of a path the load factors of branch:1, limit:1, contact:1 and the first of every [[event]] (empty: there
/// was none), then the run_columns, with the values of the last row.
std::vector<std::string> sweep_columns(const std::vector<std::string>& keys, const Problem& problem, const std::vector<OwnLaw>& own = {});
Row sweep_row(const std::vector<Cell>& values, const std::string& status, const Table& path, const Table& events,
              const Problem& problem, const Table& curve = {});

// A motion as rows of trajectory.csv and frames.

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
