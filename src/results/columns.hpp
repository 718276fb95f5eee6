#pragma once
// The columns of path.csv, events.csv and sweep.csv, and how a point of a path becomes a row of them.
#include "path/point.hpp"
#include "model/model.hpp"
#include "input/problem.hpp"
#include "results/table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// The names of every [[observe]], and behind them eigenvalue_1 … as many as the study has, and the terms of a program's own laws.
std::vector<std::string> observable_columns(const Problem& problem, const std::vector<OwnLaw>& own = {});

/// The columns of the table of a run: of path.csv, or of trajectory.csv.
std::vector<std::string> run_columns(const Problem& problem, const std::vector<OwnLaw>& own = {});

/// step, label, branch, lambda, energy, bond, angle, contact, wall, cohesion, body, external, residual, iterations, negative,
/// stable, then the observables, parent, negative_rigid, and `stage` of a path in stages.
std::vector<std::string> path_columns(const std::vector<std::string>& observables, bool staged = false);
/// stage: of a path in stages, the name of the point's.
Row path_row(const PathPoint& point, const std::vector<double>& observables,
             const std::optional<std::string>& stage = std::nullopt);

/// label, lambda, multiplicity, then the columns of path.csv without label and lambda, with negative_before,
/// negative_after and what behind negative_rigid.
std::vector<std::string> event_columns(const std::vector<std::string>& observables, bool staged = false);
Row event_row(const PathPoint& point, const std::vector<double>& observables,
              const std::optional<std::string>& stage = std::nullopt);

/// An event's label has a colon and a number, as in "branch:1"; "initial" and "final" are no events.
bool is_event(const std::string& label);

/// The swept keys, status, of a path the load factors of branch:1, limit:1, contact:1 and the first of every [[event]] (empty: there
/// was none), then the run_columns, with the values of the last row.
std::vector<std::string> sweep_columns(const std::vector<std::string>& keys, const Problem& problem, const std::vector<OwnLaw>& own = {});
Row sweep_row(const std::vector<Cell>& values, const std::string& status, const Table& path, const Table& events,
              const Problem& problem);
}  // namespace elamin
