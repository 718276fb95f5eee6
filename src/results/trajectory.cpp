#include "results/trajectory.hpp"

#include <filesystem>

namespace elamin {

std::vector<std::string> trajectory_columns(const std::vector<std::string>& observables) {
  std::vector<std::string> columns{"step", "label", "time"};
  for (const auto& more : {energy_columns(), {"kinetic", "work", "dissipation", "balance"}, observables})
    columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

Row trajectory_row(const Moment& m, const std::vector<double>& observables) {
  const double energy = m.energy.total();
  Row row{static_cast<int>(m.motion.step), m.label, m.motion.time, energy};
  for (const auto& [name, term] : EnergyTerms::known()) row.emplace_back(m.energy.*term);
  row.insert(row.end(), {m.kinetic, m.motion.work, m.motion.dissipation, energy + m.kinetic + m.motion.dissipation - m.motion.work});
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
  if (model.bodies.empty()) return;
  CsvFile bodies(std::filesystem::path(file).replace_extension(".bodies.csv").string(),
                 {"id", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "Lx", "Ly", "Lz", "fx", "fy", "fz", "tx", "ty", "tz"});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Pose& pose = motion.state.bodies[b];
    const Eigen::Vector4d q = (pose.rotation.w() < 0 ? -1 : 1) * pose.rotation.coeffs();   // x, y, z, w
    Row row{model.bodies[b].id};
    for (const double x : pose.position.hi) row.emplace_back(x);
    for (const int k : {3, 0, 1, 2}) row.emplace_back(q[k]);
    for (const Field* field : {&motion.body_velocity, &motion.angular_momentum, &motion.body_force, &motion.torque})
      for (int c = 0; c < 3; ++c) row.emplace_back((*field)(c, static_cast<Eigen::Index>(b)));
    bodies.add(row);
  }
}

}  // namespace elamin
