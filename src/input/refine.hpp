#pragma once
// The same structure with finer and finer spacing.
#include "input/keys.hpp"

namespace elamin {

struct RefineTable {
  TablePlace place;
  int by = 2, levels = 3;
  std::vector<std::string> divide;       // numbers of the file that go with the spacing
  bool operator==(const RefineTable&) const = default;
};

void describe(Keys& keys, RefineTable& t);

}  // namespace elamin
