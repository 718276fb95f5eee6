#pragma once
// Whole paths for tests.
#include "path/path.hpp"

namespace elamin {

struct Trace {
  std::vector<PathPoint> points;
  std::vector<std::string> notes;
  Status status = Status::converged;
  std::string why;

  std::vector<PathPoint> labelled(const std::string& kind) const {
    std::vector<PathPoint> found;
    for (const PathPoint& p : points)
      if (p.label.starts_with(kind + ":")) found.push_back(p);
    return found;
  }
  /// Labels in order, but for those that are empty.
  std::vector<std::string> labels() const {
    std::vector<std::string> all;
    for (const PathPoint& p : points)
      if (!p.label.empty()) all.push_back(p.label);
    return all;
  }
};

inline Trace trace(Newton& newton, const State& start, const PathOptions& options) {
  auto path = make_path(newton, start, options);
  Trace t;
  while (auto point = path->next()) t.points.push_back(std::move(*point));
  t.notes = path->notes(), t.status = path->status(), t.why = path->why();
  return t;
}

/// Steps in arc length that stay on the branch.
inline PathOptions arcs(double to, int steps) {
  PathOptions o;
  o.method = PathMethod::arc_length, o.when_unstable = WhenUnstable::follow, o.to = to, o.steps = steps;
  return o;
}

}  // namespace elamin
