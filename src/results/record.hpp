#pragma once
// What a run has found so far, in memory: the rows of its path and of its events.
#include "path/point.hpp"
#include "results/observables.hpp"
#include "results/table.hpp"

namespace elamin {

class Record {
 public:
  /// Both must outlive this. Throws InputError as Observables does.
  Record(const Problem& problem, const Model& model);

  /// A point of the path; forces: −∂U/∂x of all particles with the loads, 3 × particles; touches: see
  /// Observables::evaluate; eigenvalues: of a study of modes. An event (a label such as "branch:1") stands in both tables.
  void add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches,
           const std::vector<double>& eigenvalues = {});

  const Table& path() const { return path_; }
  const Table& events() const { return events_; }
  /// Names of the last columns, see observable_columns.
  const std::vector<std::string>& columns() const { return names_; }
  const Observables& observables() const { return observables_; }

 private:
  Observables observables_;
  std::vector<std::string> names_;
  Table path_, events_;
};

}  // namespace elamin
