#pragma once
// How a structure differs from what is meant.
#include "input/keys.hpp"

namespace elamin {

enum class Distribution { uniform, normal };

struct ImperfectionTable {
  TablePlace place;
  std::optional<std::vector<int>> modes;         // either these …
  std::optional<std::vector<double>> amplitudes;
  std::string run;
  std::optional<std::string> at;
  std::string state;                             // … or this …
  std::optional<double> scale;
  std::optional<double> random;                  // … or this
  std::optional<int> seed;
  std::optional<Distribution> distribution;
  std::string group = "all";
  bool stress_free = true;
  bool operator==(const ImperfectionTable&) const = default;
};

void describe(Keys& keys, ImperfectionTable& t);
void check(ImperfectionTable& t, Mistakes& mistakes);

}  // namespace elamin
