#pragma once
// The equilibria at given load factors, and the barriers between them.
#include "input/keys.hpp"
#include "path/landscape_options.hpp"

#include <optional>

namespace elamin {

struct LandscapeTable {
  TablePlace place;
  std::optional<std::vector<double>> at;
  int modes = LandscapeOptions{}.modes, starts = LandscapeOptions{}.starts, deflate = LandscapeOptions{}.deflate;
  int most = LandscapeOptions{}.most;
  int seed = static_cast<int>(LandscapeOptions{}.seed);
  bool strings = LandscapeOptions{}.strings;
  std::string run;
  bool operator==(const LandscapeTable&) const = default;
};

void describe(Keys& keys, LandscapeTable& t);

/// Where an expectation looks at a landscape: a label, or "graph", and the load factor, or that of the last landscape.
struct InLandscape {
  std::string label;
  std::optional<double> load_factor;
};

/// Whether `at` begins with "landscape."; what "landscape.saddle:1@0.5" says, nothing if that cannot be understood.
bool is_of_landscape(const std::string& at);
std::optional<InLandscape> in_landscape(const std::string& at);

}  // namespace elamin
