#pragma once
// Named sets of particles and bodies.
#include "input/region.hpp"


namespace elamin {

struct GroupTable {
  TablePlace place;
  std::string name, from_stage;          // of its particles: the stage they are there from
  std::vector<std::string> of{"all"};
  std::optional<std::vector<std::string>> except;
  std::optional<int> first, last, middle;
  std::optional<std::vector<int>> ids;
  struct Inside {
    TablePlace place;
    Region region;
    bool operator==(const Inside&) const = default;
  };
  std::optional<Inside> inside, outside;
  bool operator==(const GroupTable&) const = default;
};

void describe(Keys& keys, GroupTable::Inside& t);
void describe(Keys& keys, GroupTable& t);

}  // namespace elamin
