#pragma once
#include "path/point.hpp"
#include "solve/report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

enum class PathMethod { load_steps, arc_length };

/// What a path does where its equilibria lose stability.
enum class WhenUnstable {
  jump,      // snap to the next minimum, as an experiment does
  follow,    // stay on the branch, stable or not
  stop
};

/// An observable whose reaching of a value is an event, labelled NAME:1, NAME:2, …
struct UserEvent {
  std::string name;
  std::function<double(const State&)> observable;
  double value = 0;
  bool stop = false;                     // the path ends there

  /// observable − value at a state, 0 if that is rounding: then the side is not known yet.
  double side(const State& state) const {
    const double here = observable(state);
    return std::abs(here - value) <= 1e-11 * std::max(std::abs(here), std::abs(value)) ? 0.0 : here - value;
  }
};

/// Finds an equilibrium near the state, from where it was predicted.
using Corrector = std::function<Report(State& state)>;

struct PathOptions {
  PathMethod method = PathMethod::load_steps;
  double from = 0, to = 1;               // load factors
  int steps = 100;                       // load steps: of equal length, halved where Newton fails, doubled again after;
                                         // arc length: no step changes the load factor by more than such a length
  WhenUnstable when_unstable = WhenUnstable::jump;
  std::optional<double> start = {};           // where on the way from `from` to `to` it starts; default `from`
  std::vector<double> stops = {};             // load factors that must be hit besides
  bool limits = true, branch_points = true, contacts = true;   // events that are located; none: a stable path snaps where a step loses its branch …
  bool event_errors = false;                 // … with what rounding may move their load factors by (event_error.hpp)
  int branches = 0;                      // branch points to switch at, both ways
  std::optional<double> lowest = {}, highest = {}; // arc length ends where the load factor leaves these; see ArcLength
  int most_points = 0;                   // on one branch; 0: twenty times `steps`
  std::vector<UserEvent> user_events = {};
  Corrector correct = {};                     // of load steps; none: Newton's method. What is between two steps is Newton's.
  Corrector descend = {};                     // to the minimum that the path begins at; none: Newton's method
  std::optional<Resume> resume = {};          // of the point that the path is taken up at
  int deflate = 0;                       // further equilibria to look for …
  std::vector<double> deflate_at = {};        // … at these load factors; none: at `to`
};

}  // namespace elamin
