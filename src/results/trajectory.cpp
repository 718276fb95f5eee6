#include "results/trajectory.hpp"

namespace elamin {

std::vector<std::string> trajectory_columns(const std::vector<std::string>& observables) {
  std::vector<std::string> columns{"step", "label",    "time",     "energy",  "bond", "angle",       "contact",
                                   "wall", "cohesion", "external", "kinetic", "work", "dissipation", "balance"};
  columns.insert(columns.end(), observables.begin(), observables.end());
  return columns;
}

Row trajectory_row(const Moment& m, const std::vector<double>& observables) {
  const double energy = m.energy.total();
  Row row{static_cast<int>(m.motion.step), m.label, m.motion.time, energy, m.energy.bond, m.energy.angle, m.energy.contact, m.energy.wall,
          m.energy.cohesion, m.energy.external, m.kinetic, m.motion.work, m.motion.dissipation,
          energy + m.kinetic + m.motion.dissipation - m.motion.work};
  row.insert(row.end(), observables.begin(), observables.end());
  return row;
}

void write_frame(const std::string& file, const Model& model, const Motion& motion) {
  CsvFile csv(file, {"id", "x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz"});
  for (int i = 0; i < model.particles(); ++i) {
    Row row{model.id[i]};
    for (const Field* field : {&motion.state.position, &motion.velocity, &motion.force})
      for (int c = 0; c < 3; ++c) row.emplace_back((*field)(c, i));
    csv.add(row);
  }
}

}  // namespace elamin
