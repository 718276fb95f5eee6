#pragma once
// How a structure differs from what is meant.
#include "input/mistakes.hpp"
#include "input/keys.hpp"

namespace elamin {

enum class Distribution { uniform, normal };

struct ImperfectionTable {
  TablePlace place;
  std::vector<int> modes;                        // either these …
  std::vector<double> amplitudes;
  std::string run, at;
  std::string state;                             // … or this …
  double scale = 1;
  std::optional<double> random;                  // … or this
  std::optional<int> seed;
  Distribution distribution = Distribution::uniform;
  std::string group = "all";
  bool stress_free = true;
  bool operator==(const ImperfectionTable&) const = default;
};

void describe(Keys& keys, ImperfectionTable& t);
void check(ImperfectionTable& t, Mistakes& mistakes);

}  // namespace elamin
