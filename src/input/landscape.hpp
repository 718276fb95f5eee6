#pragma once
// The equilibria at given load factors, and the barriers between them.
#include "input/keys.hpp"
#include "path/landscape_options.hpp"

#include <optional>

namespace elamin {

struct LandscapeTable : LandscapeOptions {
  TablePlace place;
  std::optional<std::vector<double>> at;
  std::string run;
  bool operator==(const LandscapeTable&) const = default;
};

void describe(Keys& keys, LandscapeTable& t);

/// The load factors of the landscapes; none in other studies.
std::vector<double> landscape_load_factors(const Problem& problem);

/// Where an expectation looks at a landscape: a label, or "graph", and the load factor, or that of the last landscape.
struct InLandscape {
  std::string label;
  std::optional<double> load_factor;
};

/// Whether `at` begins with "landscape."; what "landscape.saddle:1@0.5" says, nothing if that cannot be understood.
bool is_of_landscape(const std::string& at);
std::optional<InLandscape> in_landscape(const std::string& at);

}  // namespace elamin
