#pragma once
// The study of an energy landscape: what [landscape] asks for, behind its path.
#include "path/landscape.hpp"
#include "results/run_directory.hpp"
#include "study/trace.hpp"

namespace elamin {

/// The load factors of the landscapes; none in other studies.
std::vector<double> landscape_load_factors(const Problem& problem);

/// What of a path a landscape begins with: its states at those load factors, and its events.
class PathOfLandscape {
 public:
  explicit PathOfLandscape(const Problem& problem) : at_(landscape_load_factors(problem)) {}
  void take(const PathPoint& point);
  const std::vector<State>& known() const { return known_; }
  const std::vector<PathEvent>& events() const { return events_; }
  void carry(Archive& archive);

 private:
  std::vector<double> at_;
  std::vector<State> known_;
  std::vector<PathEvent> events_;
};

/// Explores the landscapes and writes them: landscape.csv, landscape.json and a state for each image of each node. `tell` is told of each of them,
/// `warn` what was not found. Not converged where one of them is empty.
Outcome trace_landscape(const Problem& problem, const Model& model, const PathOfLandscape& path, RunDirectory& results,
                        const std::function<void(const std::string&)>& tell, const std::function<void(const std::string&)>& warn);

}  // namespace elamin
