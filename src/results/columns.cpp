#include "results/columns.hpp"

#include "input/check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace elamin {

namespace {

/// An index that is known.
Cell known(int index) { return index < 0 ? Cell{} : Cell(index); }

/// What path.csv and events.csv have in common behind their first columns.
void append_rest(Row& row, const PathPoint& p, const std::vector<double>& observables) {
  row.emplace_back(p.energy.total());
  for (const auto& [name, term] : EnergyTerms::known()) row.emplace_back(p.energy.*term);
  row.insert(row.end(), {p.report.residual, p.report.iterations, p.stability.negative, p.stability.stable});
  row.insert(row.end(), observables.begin(), observables.end());
  row.insert(row.end(), {p.parent, known(p.stability.negative_rigid)});
}

const std::vector<std::string> further{"residual", "iterations", "negative", "stable"};
const std::vector<std::string> last_columns{"parent", "negative_rigid"}, last_of_event{"negative_before", "negative_after", "what"};

void append(std::vector<std::string>& to, const std::vector<std::string>& more) { to.insert(to.end(), more.begin(), more.end()); }

std::vector<std::string> with_rest(std::vector<std::string> columns, const std::vector<std::string>& observables) {
  append(columns, energy_columns());
  for (const auto* more : {&further, &observables, &last_columns}) append(columns, *more);
  return columns;
}

std::vector<std::string> first_events(const Problem& problem) {
  std::vector<std::string> labels;
  if (!problem.in_time()) labels = {"branch:1", "limit:1", "contact:1"};
  for (const EventTable& e : problem.events) labels.push_back(e.name + ":1");
  return labels;
}

}  // namespace

std::vector<std::string> observable_columns(const Problem& problem, const std::vector<OwnLaw>& own) {
  std::vector<std::string> names;
  for (const ObserveTable& o : problem.observe) names.push_back(o.name);
  for (const std::string& name : eigenvalue_columns(problem)) names.push_back(name);
  for (const OwnLaw& law : own) names.push_back(law.term);
  return names;
}

std::vector<std::string> run_columns(const Problem& problem, const std::vector<OwnLaw>& own) {
  const std::vector<std::string> observables = observable_columns(problem, own);
  return problem.in_time() ? trajectory_columns(observables) : path_columns(observables, !problem.stages.empty());
}

std::vector<std::string> curve_columns(const std::vector<std::string>& observables) {
  std::vector<std::string> columns = with_rest({"second", "label", "lambda"}, observables);
  append(columns, {"multiplicity", "asymmetry", "what"});
  return columns;
}

Row curve_row(double second, double asymmetry, const PathPoint& p, const std::vector<double>& observables) {
  Row row{second, p.label, p.state.load_factor};
  append_rest(row, p, observables);
  row.insert(row.end(), {p.multiplicity, asymmetry, p.what});
  return row;
}

std::vector<std::string> node_columns(const std::vector<std::string>& observables) { return with_rest({"label", "lambda"}, observables); }

Row node_row(const PathPoint& p, const std::vector<double>& observables) {
  Row row{p.label, p.state.load_factor};
  append_rest(row, p, observables);
  return row;
}

std::vector<std::string> path_columns(const std::vector<std::string>& observables, bool staged) {
  std::vector<std::string> columns = with_rest({"step", "label", "branch", "lambda"}, observables);
  if (staged) columns.push_back("stage");
  return columns;
}

Row path_row(const PathPoint& p, const std::vector<double>& observables, const std::optional<std::string>& stage) {
  Row row{p.step, p.label, p.branch, p.state.load_factor};
  append_rest(row, p, observables);
  if (stage) row.emplace_back(*stage);
  return row;
}

std::vector<std::string> event_columns(const std::vector<std::string>& observables, bool staged, bool errors) {
  std::vector<std::string> columns = with_rest({"label", "lambda", "multiplicity", "step", "branch"}, observables);
  append(columns, last_of_event);
  if (errors) columns.push_back("lambda_error");
  if (staged) columns.push_back("stage");
  return columns;
}

Row event_row(const PathPoint& p, const std::vector<double>& observables, const std::optional<std::string>& stage, bool errors) {
  Row row{p.label, p.state.load_factor, p.multiplicity, p.step, p.branch};
  append_rest(row, p, observables);
  row.insert(row.end(), {known(p.negative_before), known(p.negative_after), p.what});
  if (errors) row.push_back(std::isnan(p.load_error) ? Cell{} : Cell(p.load_error));
  if (stage) row.emplace_back(*stage);
  return row;
}

bool is_event(const std::string& label) { return label.find(':') != std::string::npos; }

std::vector<std::string> sweep_columns(const std::vector<std::string>& keys, const Problem& problem, const std::vector<OwnLaw>& own) {
  std::vector<std::string> columns = keys;
  columns.push_back("status");
  append(columns, first_events(problem));
  if (problem.curve) append(columns, {"second"});
  append(columns, run_columns(problem, own));
  return columns;
}

Row sweep_row(const std::vector<Cell>& values, const std::string& status, const Table& path, const Table& events,
              const Problem& problem, const Table& curve) {
  Row row(values.begin(), values.end());
  row.emplace_back(status);
  for (const std::string& label : first_events(problem)) {
    const auto it = std::find_if(events.rows.begin(), events.rows.end(), [&](const Row& r) { return r[0] == Cell(label); });
    row.push_back(it == events.rows.end() ? Cell{} : (*it)[1]);
  }
  if (problem.curve) row.push_back(curve.rows.empty() ? Cell{} : curve.rows.back().front());
  const Row final_row = path.rows.empty() ? Row(path.columns.size()) : path.rows.back();
  row.insert(row.end(), final_row.begin(), final_row.end());
  return row;
}

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
  WholeCsv particles(file, {"id", "x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz"});
  for (int i = 0; i < model.particles(); ++i) {
    Row row{model.id[i]};
    for (const Field* field : {&motion.state.position, &motion.velocity, &motion.force})
      for (int c = 0; c < 3; ++c) row.emplace_back((*field)(c, i));
    particles.add(row);
  }
  particles.keep();
  if (model.bodies.empty()) return;
  WholeCsv bodies(std::filesystem::path(file).replace_extension(".bodies.csv").string(),
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
  bodies.keep();
}

}  // namespace elamin
