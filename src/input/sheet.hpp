#pragma once
// A triangular lattice of particles.
#include "input/stiffness.hpp"
#include "model/sheet.hpp"

namespace elamin {

using SheetShape = Sheet::Shape;

struct SheetTable : StiffnessKeys {
  TablePlace place;
  std::string name, from_stage, values;
  SheetShape shape = SheetShape::rectangle;
  std::optional<std::array<double, 2>> size;
  std::optional<double> radius, height;
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  double lattice_angle = 0, spacing = 0;
  std::optional<double> diameter;
  bool operator==(const SheetTable&) const = default;
};

void describe(Keys& keys, SheetTable& t);
void check(SheetTable& t, Mistakes& mistakes);
/// The sheet; none, and said why, if it cannot be built.
std::optional<Sheet> built(const SheetTable& t, Mistakes& mistakes);

}  // namespace elamin
