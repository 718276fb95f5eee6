#pragma once
// What a run has found so far, in memory: the rows of its path and of its events.
#include "path/point.hpp"
#include "input/stages.hpp"
#include "results/observables.hpp"
#include "results/table.hpp"
#include "results/columns.hpp"

#include <optional>
#include <string>

namespace elamin {

class Record {
 public:
  /// Both must outlive this. Throws InputError as Observables does.
  Record(const Problem& problem, const Model& model);

  /// The points that come belong to this stage of the path, in which this model is in force (it must outlive this).
  void enter(const Stage& stage, const Model& model);

  /// A point of the path; forces: −∂U/∂x of all sites with the loads, 3 × sites; touches: see
  /// Observables::evaluate; eigenvalues: the lowest, where the study has them. An event (a label such as "branch:1") stands in both tables.
  void add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches, const std::vector<double>& eigenvalues = {});

  /// A moment of a motion; touches as above.
  void add(const Moment& moment, const std::vector<Touch>& touches);

  /// The rows so far of a run that was stopped, as they were read again.
  void take_up(Table path, Table events);

  const Problem& problem() const { return problem_; }
  const Table& path() const { return path_; }
  const Table& events() const { return events_; }
  /// Names of the last columns, see observable_columns.
  const std::vector<std::string>& columns() const { return names_; }
  const Observables& observables() const { return *observables_; }

 private:
  const Problem& problem_;
  const Model* model_ = nullptr;                                 // of the stage
  std::optional<Observables> observables_;                       // of the stage
  std::optional<std::string> stage_;                             // of a path in stages, its name
  std::vector<std::string> names_;
  Table path_, events_;
};

}  // namespace elamin
