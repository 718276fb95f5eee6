#pragma once
// Motion in time: velocity Verlet, viscosity, velocities at the start; damped dynamics.
#include "input/keys.hpp"


namespace elamin {

struct ViscosityTable {
  TablePlace place;
  std::string group = "all";
  double coefficient = 0;
  bool operator==(const ViscosityTable&) const = default;
};

struct VelocityTable {
  TablePlace place;
  std::string group = "all";
  std::optional<Vec3> velocity, angular_velocity;
  bool operator==(const VelocityTable&) const = default;
};

struct DynamicsTable {
  TablePlace place;
  std::optional<double> timestep;
  int steps = 1000, every = 100;
  std::optional<std::vector<int>> record;
  std::vector<std::string> film;
  bool relax = false, allow_unstable = false;
  bool operator==(const DynamicsTable&) const = default;
};

void describe(Keys& keys, ViscosityTable& t);
void describe(Keys& keys, VelocityTable& t);
void describe(Keys& keys, DynamicsTable& t);

}  // namespace elamin
