#pragma once
// A threshold of a path as a curve in a second parameter.
#include "input/keys.hpp"

namespace elamin {

struct CurveTable {
  TablePlace place;
  std::string of;                        // the label of an event: limit:1, branch:1, contact:1, or of the snap that begins there, jump:1
  std::string second;                    // a key, as `--set` has it
  double from = 0, to = 0;               // its values; the path is traced at `from`
  int steps = 40;
  std::optional<std::vector<double>> stops;
  std::vector<std::string> until;        // labels at which it ends
  bool operator==(const CurveTable&) const = default;
};

void describe(Keys& keys, CurveTable& t);

/// The value of "second=0.5", where an expectation looks at a curve; nothing of another `at`.
std::optional<double> second_of(const std::string& at);

/// Whether `at` is a point of a curve: that, or a label such as cusp:1.
bool is_of_curve(const std::string& at);

}  // namespace elamin
