#pragma once
// A sweep that looks for the value of a key at which an outcome changes.
#include "input/document.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"
#include "input/settings.hpp"

#include <string>
#include <vector>

namespace elamin {

/// What [[sweep]] with `between` and `bisect` asks for. The outcome of a run is on which side of `level` its observable is
/// at the row `at`, or that it has none there.
struct Bisection {
  std::vector<std::string> keys;       // all get the same value
  double lo = 0, hi = 0;               // between these, in either order
  bool integers = false;               // of the key
  std::string observable, at;
  double level = 0, tolerance = 0;     // halving ends when lo and hi are this near
  Place place;

  /// The value between lo and hi, and whether lo and hi are near enough; integers end at neighbours.
  double middle() const;
  bool narrow() const;
  std::vector<Setting> settings(double value) const;
};

/// Whether a sweep is one of these, by its keys.
bool bisects(const Sweep& sweep);

/// The bisection that a sweep asks for; what is wrong goes to the mistakes.
Bisection read_bisection(Sweep& sweep, const Problem& problem, Mistakes& mistakes);

}  // namespace elamin
