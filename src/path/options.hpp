#pragma once
#include <optional>
#include <vector>

namespace elamin {

/// What a path does where its equilibria lose stability.
enum class WhenUnstable {
  jump,      // fall to the next minimum, as an experiment does
  follow,    // stay on the branch, stable or not
  stop
};

struct LoadStepOptions {
  double from = 0, to = 1;             // load factors
  int steps = 100;                     // of equal length; halved where Newton fails, doubled again after
  WhenUnstable when_unstable = WhenUnstable::jump;
  std::optional<double> start;         // where on the way from `from` to `to` it starts; default `from`
  std::vector<double> stops;           // load factors that must be hit besides
  bool contacts = true;                // locate where contacts are made and lost
};

}  // namespace elamin
