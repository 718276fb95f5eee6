#pragma once
// A closed ring of particles.
#include "input/stiffness.hpp"
#include "model/loop.hpp"


namespace elamin {

struct LoopTable : RowStiffnessKeys {
  TablePlace place;
  std::string name, from_stage, values;
  int particles = 0;
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  double radius = 0, diameter = 0;
  bool operator==(const LoopTable&) const = default;
};

void describe(Keys& keys, LoopTable& t);
void check(LoopTable& t, Mistakes& mistakes);
/// The ring; none, and said why, if it cannot be built.
std::optional<Ring> built(const LoopTable& t, Mistakes& mistakes);

}  // namespace elamin
