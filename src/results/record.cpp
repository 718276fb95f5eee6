#include "results/record.hpp"

#include "core/error.hpp"
#include "model/entities.hpp"
#include "results/columns.hpp"

#include <limits>
#include <set>
#include <utility>

namespace elamin {

namespace {

/// Of all sites, as Energy::forces has them: torques over the levers of the bodies.
Field site_forces(const Model& model, const Motion& m) {
  Field all = Field::Zero(3, model.particles() + 2 * static_cast<int>(model.bodies.size()));
  all.leftCols(m.force.cols()) = m.force;
  for (Eigen::Index b = 0; b < m.body_force.cols(); ++b) {
    all.col(model.particles() + 2 * b) = m.body_force.col(b);
    all.col(model.particles() + 2 * b + 1) = m.torque.col(b) / (size_of(model, model.particles() + static_cast<int>(b)) / 2);
  }
  return all;
}

}  // namespace

Record::Record(const Problem& problem, const Model& model)
    : problem_(problem),
      names_(observable_columns(problem, model.own)),
      path_{run_columns(problem, model.own), {}},
      events_{event_columns(names_, !problem.stages.empty(), problem.event_errors()), {}} {
  const Stage whole;
  enter(whole, model);
}

void Record::enter(const Stage& stage, const Model& model) {
  observables_.emplace(problem_, model);
  model_ = &model;
  if (!problem_.stages.empty()) stage_ = stage.name;
}

void Record::add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches, const std::vector<double>& eigenvalues) {
  std::vector<double> values = observables_->evaluate(point.state, forces, touches);
  values.insert(values.end(), eigenvalues.begin(), eigenvalues.end());
  values.resize(names_.size() - model_->own.size(), std::numeric_limits<double>::quiet_NaN());     // fewer dofs than modes asked for
  for (std::size_t k = 0; k < model_->own.size(); ++k) values.push_back(point.energy.own[k].second);
  path_.rows.push_back(path_row(point, values, stage_));
  if (is_event(point.label)) events_.rows.push_back(event_row(point, values, stage_, problem_.event_errors()));
}

void Record::take_up(Table path, Table events) {
  const std::set<std::string> whole{"step", "branch", "multiplicity", "iterations", "negative", "negative_rigid", "negative_before", "negative_after"};
  for (auto [from, to] : {std::pair(&path, &path_), {&events, &events_}}) {
    if (from->columns.empty()) continue;
    if (from->columns != to->columns) throw InputError("its tables have other columns than those that the problem asks for");
    for (Row& row : from->rows)
      for (std::size_t c = 0; c < row.size(); ++c)
        if (const int* number = std::get_if<int>(&row[c]); number && !whole.count(to->columns[c])) row[c] = static_cast<double>(*number);
    to->rows = std::move(from->rows);
  }
}

void Record::add(const Moment& moment, const std::vector<Touch>& touches) {
  const Motion& m = moment.motion;
  path_.rows.push_back(trajectory_row(moment, observables_->evaluate(m.state, site_forces(*model_, m), touches, &m)));
}

}  // namespace elamin
