#include "results/columns.hpp"

#include "problem/check.hpp"

#include <algorithm>

namespace elamin {
namespace {

/// What path.csv and events.csv have in common behind their first columns.
void append_rest(Row& row, const PathPoint& p, const std::vector<double>& observables) {
  row.insert(row.end(), {p.energy.total(), p.energy.bond, p.energy.angle, p.energy.contact, p.energy.wall, p.energy.cohesion,
                         p.energy.external, p.report.residual, p.report.iterations, p.stability.negative,
                         p.stability.stable});
  row.insert(row.end(), observables.begin(), observables.end());
}

const std::vector<std::string> rest{"energy",   "bond",     "angle",      "contact",  "wall",  "cohesion",
                                    "external", "residual", "iterations", "negative", "stable"};

std::vector<std::string> with_rest(std::vector<std::string> columns, const std::vector<std::string>& observables) {
  columns.insert(columns.end(), rest.begin(), rest.end());
  columns.insert(columns.end(), observables.begin(), observables.end());
  return columns;
}

const std::vector<std::string> first_events{"branch:1", "limit:1", "contact:1"};

}  // namespace

std::vector<std::string> observable_columns(const Problem& problem) {
  std::vector<std::string> names;
  for (const ObserveTable& o : problem.observe) names.push_back(o.name);
  if (problem.study == StudyType::modes)
    for (const std::string& name : eigenvalue_columns(problem.modes.count)) names.push_back(name);
  return names;
}

std::vector<std::string> path_columns(const std::vector<std::string>& observables) {
  return with_rest({"step", "label", "branch", "lambda"}, observables);
}

Row path_row(const PathPoint& p, const std::vector<double>& observables) {
  Row row{p.step, p.label, p.branch, p.state.load_factor};
  append_rest(row, p, observables);
  return row;
}

std::vector<std::string> event_columns(const std::vector<std::string>& observables) {
  return with_rest({"label", "lambda", "multiplicity", "step", "branch"}, observables);
}

Row event_row(const PathPoint& p, const std::vector<double>& observables) {
  Row row{p.label, p.state.load_factor, p.multiplicity, p.step, p.branch};
  append_rest(row, p, observables);
  return row;
}

bool is_event(const std::string& label) { return label.find(':') != std::string::npos; }

std::vector<std::string> sweep_columns(const std::vector<std::string>& keys,
                                       const std::vector<std::string>& observables) {
  std::vector<std::string> columns = keys;
  columns.push_back("status");
  columns.insert(columns.end(), first_events.begin(), first_events.end());
  const std::vector<std::string> path = path_columns(observables);
  columns.insert(columns.end(), path.begin(), path.end());
  return columns;
}

Row sweep_row(const std::vector<Cell>& values, const std::string& status, const Table& path, const Table& events) {
  Row row(values.begin(), values.end());
  row.emplace_back(status);
  for (const std::string& label : first_events) {
    const auto it =
        std::find_if(events.rows.begin(), events.rows.end(), [&](const Row& r) { return r[0] == Cell(label); });
    row.push_back(it == events.rows.end() ? Cell{} : (*it)[1]);
  }
  const Row last = path.rows.empty() ? Row(path.columns.size()) : path.rows.back();
  row.insert(row.end(), last.begin(), last.end());
  return row;
}

}  // namespace elamin
