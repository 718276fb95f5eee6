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

  /// A point of the path; forces: −∂U/∂x of all particles with the loads, 3 × particles. An event (a label such as
  /// "branch:1") stands in both tables.
  void add(const PathPoint& point, const Field& forces);

  const Table& path() const { return path_; }
  const Table& events() const { return events_; }
  const std::vector<std::string>& observables() const { return names_; }

 private:
  Observables observables_;
  std::vector<std::string> names_;
  Table path_, events_;
};

}  // namespace elamin
