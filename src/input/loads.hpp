#pragma once
// What acts: dead loads, gravity, pressure, and changes of what there is.
#include "input/keys.hpp"


namespace elamin {

struct LoadTable {
  TablePlace place;
  std::string name, group;
  std::optional<Vec3> force, total_force;       // one of these …
  std::optional<double> radial;                 // … or this
  std::optional<Vec3> center, axis;
  std::optional<Vec3> point, torque;
  bool constant = false;
  std::string from_stage;
  bool operator==(const LoadTable&) const = default;
};

struct GravityTable {
  TablePlace place;
  std::string name, group = "all";
  Vec3 acceleration = Vec3::Zero();
  bool constant = true;
  std::string from_stage;
  bool operator==(const GravityTable&) const = default;
};

struct PressureTable {
  TablePlace place;
  std::string name;
  std::optional<std::string> loop, sheet;       // on one of these
  double pressure = 0;
  bool constant = false;
  std::string from_stage;
  bool operator==(const PressureTable&) const = default;
};

struct ChangeTable {
  TablePlace place;
  std::string name, group;
  std::optional<double> rest_length, bond_stiffness, angle_stiffness;
  bool constant = false;
  std::string from_stage;
  bool operator==(const ChangeTable&) const = default;
};

void describe(Keys& keys, LoadTable& t);
void describe(Keys& keys, GravityTable& t);
void describe(Keys& keys, PressureTable& t);
void describe(Keys& keys, ChangeTable& t);

}  // namespace elamin
