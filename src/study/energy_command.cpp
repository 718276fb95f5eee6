#include "study/commands.hpp"

#include "core/say.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "energy/energy.hpp"
#include "input/read.hpp"
#include "input/stages.hpp"
#include "results/json.hpp"
#include "study/imperfection.hpp"
#include "study/run.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace elamin {

namespace {

/// Forces on everything, held or not; torques about the bodies' places.
struct Forces {
  Field particles, bodies, torques;
};

Forces forces_of(Energy& energy, const State& state) {
  const Model& model = energy.model();
  const Kinematics& kinematics = energy.kinematics();
  const Field all = energy.forces(state);
  const auto n = static_cast<Eigen::Index>(model.bodies.size());
  Forces forces{all.leftCols(model.particles()), Field(3, n), Field(3, n)};
  for (int b = 0; b < n; ++b) {
    forces.bodies.col(b) = all.col(kinematics.place_of(b));
    forces.torques.col(b) = kinematics.characteristic_length(b) * all.col(kinematics.rotation_of(b));   // of a rotation ℓθ the force is the torque over ℓ
  }
  return forces;
}

// Drag acts on a moving state; it has no energy.
void add_drag(const Model& model, Forces& forces) {
  for (const Viscosity& v : model.viscosity) {
    if (model.velocity.cols() > 0)
      for (const int p : v.particles) forces.particles.col(p) -= v.coefficient * model.velocity.col(p);
    if (model.body_velocity.cols() > 0)
      for (const int b : v.bodies) forces.bodies.col(b) -= v.coefficient * model.body_velocity.col(b);
  }
}

/// Bodies that follow LAMMPS's rules: the energy that LAMMPS reports; forces with the damping of a moving state.
void add_lammps(const Model& model, const State& state, EnergyTerms& terms, Forces& forces) {
  if (!follows_lammps(model)) return;
  const LammpsBodyForces lammps = lammps_body_forces(model, state, {model.velocity, model.body_velocity, model.angular_momentum});
  terms.body += lammps.energy;
  forces.particles += lammps.on_particles;
  for (std::size_t b = 0; b < lammps.on.size(); ++b) {
    forces.bodies.col(static_cast<Eigen::Index>(b)) += lammps.on[b].force;
    forces.torques.col(static_cast<Eigen::Index>(b)) += lammps.on[b].torque;
  }
}

void write_forces(const std::string& file, const Model& model, const Forces& forces) {
  const auto row = [](int id, const std::vector<Vec3>& vectors) {
    Row cells{id};
    for (const Vec3& v : vectors)
      for (const double x : v) cells.emplace_back(x + 0.0);        // no negative zeros
    return cells;
  };
  WholeCsv particles(file, {"id", "fx", "fy", "fz"}, Digits::all);
  for (int p = 0; p < model.particles(); ++p) particles.add(row(model.id[p], {forces.particles.col(p)}));
  particles.keep();
  if (model.bodies.empty()) return;
  std::string name = file;
  if (name.ends_with(".csv")) name.resize(name.size() - 4);
  WholeCsv bodies(name + ".bodies.csv", {"id", "fx", "fy", "fz", "tx", "ty", "tz"}, Digits::all);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    bodies.add(row(model.bodies[b].id, {forces.bodies.col(b), forces.torques.col(b)}));
  bodies.keep();
}

/// What there is and what is in force as the problem begins: in the first of its stages.
Model at_start(const Problem& problem) {
  Model all = model_of(problem);
  if (problem.stages.empty()) return all;
  Stages stages(problem);
  std::string unclear;
  const Stage first = stages.enter(unclear);
  return model_in(problem, first, all, all.restart.value_or(all.start));
}

double largest_column(const Field& f) { return f.cols() ? f.colwise().norm().maxCoeff() : 0.0; }

}  // namespace

int energy_command(const EnergyOptions& options) {
  const Problem problem = read_problem(options.file, options.settings);
  const Model model = at_start(problem);
  Energy energy(model);
  State state = starting_state(problem, energy);
  if (options.load_factor) energy.kinematics().prescribe(state, *options.load_factor);
  EnergyTerms terms = energy.terms(state);
  Forces forces = forces_of(energy, state);
  add_drag(model, forces);
  add_lammps(model, state, terms, forces);
  const double max_force = std::max(largest_column(forces.particles), largest_column(forces.bodies));
  if (!options.forces_file.empty()) write_forces(options.forces_file, model, forces);

  const auto status = [&] {
    if (std::isfinite(terms.total()) && std::isfinite(max_force)) return exit_done;
    complain("{}\n", not_finite(energy, state));
    return exit_not_converged;
  };
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{:24.17g}", v) : fmt::format("{:>24}", "not finite"); };
  if (options.json) {
    Json out;
    out["energy"]["total"] = json_of(terms.total());
    terms.for_each([&](const auto& name, double value) { out["energy"][name] = json_of(value); });
    out["max_force"] = json_of(max_force);
    out["particles"] = model.particles(), out["bodies"] = model.bodies.size(), out["dofs"] = energy.dofs();
    say("{}\n", out.dump());
    return status();
  }
  say("load factor {:.17g}\n", state.load_factor);
  say("energy      {}\n", number(terms.total()));
  terms.for_each([&](const auto& name, double value) { say("  {:<10}{}\n", name, number(value)); });
  if (!std::isfinite(max_force)) return status();
  if (model.bodies.empty())
    say("largest force on a particle {:.17g}\n{} particles, {} free dofs\n", max_force, model.particles(), energy.dofs());
  else
    say("largest force {:.17g}\n{} particles, {} bodies, {} free dofs\n", max_force, model.particles(), model.bodies.size(), energy.dofs());
  return status();
}

}  // namespace elamin
