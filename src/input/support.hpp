#pragma once
// What is held, and moved.
#include "input/body.hpp"


namespace elamin {

struct SupportTable {
  TablePlace place;
  std::string name, group;
  std::optional<std::string> directions, rotations;
  Vec3 displacement = Vec3::Zero(), velocity = Vec3::Zero();
  bool constant = false;
  std::string from_stage;
  std::optional<TurnTable> rotation;
  bool operator==(const SupportTable&) const = default;
};

void describe(Keys& keys, SupportTable& t);

}  // namespace elamin
