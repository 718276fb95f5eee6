#pragma once
// The study of an energy landscape: what [landscape] asks for, behind its path.
#include "path/landscape.hpp"
#include "results/run_directory.hpp"
#include "study/trace.hpp"

namespace elamin {

/// What a landscape begins with: its load factors, none in other studies, and of the path the states at these, and the events.
struct PathOfLandscape {
  explicit PathOfLandscape(const Problem& problem) : load_factors(landscape_load_factors(problem)) {}
  void take(const PathPoint& point);
  void carry(Archive& archive) { archive(known, events); }

  std::vector<double> load_factors;
  std::vector<State> known;
  std::vector<PathEvent> events;
};

/// Explores the landscapes and writes them: landscape.csv, landscape.json and a state for each image of each node. `tell` is told of each of them,
/// `warn` what was not found. Not converged where one of them is empty.
Outcome trace_landscape(const Problem& problem, const Model& model, const PathOfLandscape& path, RunDirectory& results,
                        const std::function<void(const std::string&)>& tell, const std::function<void(const std::string&)>& warn);

}  // namespace elamin
