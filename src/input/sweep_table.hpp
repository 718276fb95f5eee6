#pragma once
// Many runs from one file.
#include "input/keys.hpp"


namespace elamin {

/// One [[sweep]]: the key and the values, a range, or two values between which an outcome changes.
struct Sweep {
  TablePlace place;
  std::vector<std::string> keys;         // all get the same value
  std::string zip;
  std::vector<std::string> values;       // as TOML
  std::vector<double> range;             // first, last, step
  std::vector<std::string> between;      // two values as TOML, to halve …
  std::string bisect, at = "final";      // … where this observable there passes
  double level = 0;
  std::optional<double> tolerance;
};

void describe(Keys& keys, Sweep& t);

}  // namespace elamin
