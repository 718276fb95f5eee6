#include "input/motion.hpp"

#include "input/parts.hpp"

#include <fmt/format.h>

#include <utility>

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

void check_motion(Problem& problem, Names& names, Mistakes& mistakes) {
  for (ViscosityTable& v : problem.viscosity) names.refer(v.place, "group", v.group);
  for (VelocityTable& v : problem.velocities) {
    names.refer(v.place, "group", v.group);
    if (!v.velocity && !v.angular_velocity && !v.place.broken)
      mistakes.add(v.place, "velocity", "is missing; it must be a list of three numbers [x, y, z], or give angular_velocity");
    else if (!problem.in_time())
      mistakes.add(v.place, v.velocity || !v.angular_velocity ? "velocity" : "angular_velocity", "belongs to dynamics, study.type = \"dynamics\" without relax");
  }
  if (problem.study != StudyType::dynamics) return;
  DynamicsTable& d = problem.dynamics;
  if (d.place.broken) return;
  if (!d.relax && !d.timestep)
    mistakes.add(d.place, "timestep", "is missing; it must be a positive number (`elamin check` tells the largest stable one for any)");
  if (d.relax && d.timestep) mistakes.add(d.place, "timestep", "is of no use with relax = true, which chooses its own");
  if (!d.relax && d.record)
    for (const int step : *d.record)
      if (step > d.steps) {
        mistakes.add(d.place, "record", fmt::format("step {} lies behind the last one, {}", step, d.steps));
        break;
      }
  for (const auto& [key, given] : {std::pair("record", d.record.has_value()), {"film", !d.film.empty()}})
    if (d.relax && given) mistakes.add(d.place, key, "is of no use with relax = true, whose way to equilibrium is no motion");
}

namespace {

void set_velocity(const Problem& problem, const VelocityTable& table, const Members& members, Model& model, Mistakes& mistakes) {
  const auto bodies = static_cast<Eigen::Index>(model.bodies.size());
  if (table.velocity) {
    stay_in_plane(problem, model, table.place, "velocity", *table.velocity, mistakes);
    if (model.velocity.cols() == 0) model.velocity = Field::Zero(3, model.particles());
    for (const int i : members.particles) model.velocity.col(i) = *table.velocity;
    if (model.body_velocity.cols() == 0) model.body_velocity = Field::Zero(3, bodies);
    for (const int b : members.bodies) model.body_velocity.col(b) = *table.velocity;
  }
  if (!table.angular_velocity) return;
  if (members.bodies.empty())
    mistakes.add(table.place, "angular_velocity", fmt::format("is of bodies, and \"{}\" has none; leave it out", table.group));
  turn_in_plane(problem, model, table.place, "angular_velocity", *table.angular_velocity, mistakes);
  if (model.angular_momentum.cols() == 0) model.angular_momentum = Field::Zero(3, bodies);
  for (const int b : members.bodies) {
    const Mat3 R = model.start.bodies[b].rotation.toRotationMatrix();
    model.angular_momentum.col(b) = R * (model.bodies[b].inertia * (R.transpose() * *table.angular_velocity));
  }
}

}  // namespace

void add_motion(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  for (const ViscosityTable& table : problem.viscosity)
    if (const auto* members = groups.find(table.place, "group", table.group))
      model.viscosity.push_back({members->particles, table.coefficient, members->bodies});
  for (const VelocityTable& table : problem.velocities)
    if (const Members* members = groups.find(table.place, "group", table.group))
      set_velocity(problem, table, *members, model, mistakes);
}

}  // namespace elamin
