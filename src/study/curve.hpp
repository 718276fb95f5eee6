#pragma once
// The study of a threshold as a second parameter changes: what [curve] asks for.
#include "input/problem.hpp"
#include "model/model.hpp"
#include "path/curve.hpp"
#include "study/trace.hpp"

#include <map>
#include <optional>
#include <string>

namespace elamin {

/// The model in force at a value of the second parameter. Throws InputError where the problem file with that value is wrong.
using ModelAt = std::function<Model(double second)>;

/// Looks among the points of a path for the event that a curve begins at: the one it names, or where the snap that it names begins.
class StartOfCurve {
 public:
  explicit StartOfCurve(const Problem& problem) : of_(problem.curve ? problem.curve->of : "") {}
  bool is_end(const PathPoint& point) const { return !of_.empty() && point.label == of_; }
  void take(const PathPoint& point);
  /// Once the path has come there; null: a snap begins at no event.
  const PathPoint* event() const { return event_ ? &*event_ : nullptr; }
  void carry(Archive& archive) { archive(seen_, event_); }

 private:
  std::string of_;
  std::map<std::string, PathPoint> seen_;      // by label, where a snap is waited for
  std::optional<PathPoint> event_;
};

/// Follows the event that a path has ended at; every point of the curve and everything that happens on it is a row of curve_columns. Where
/// the structure cannot be made, or has other particles, bonds or coordinates, the curve ends and the outcome says so.
Outcome trace_curve(const Problem& problem, const ModelAt& models, const PathPoint& event,
                    const std::function<void(const Row&, const Threshold&)>& found);

}  // namespace elamin
