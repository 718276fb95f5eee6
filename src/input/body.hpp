#pragma once
// A rigid body with rounded corners, what it carries, and rotations.
#include "input/keys.hpp"
#include "laws/section.hpp"

namespace elamin {

/// A rotation by an angle about an axis.
struct TurnTable {
  TablePlace place;
  Vec3 axis = Vec3::UnitZ();                    // of any length but zero
  double angle = 0;                             // degrees
  /// The rotation vector [rad].
  Vec3 vector() const { return angle * pi / 180 * (axis / axis.cwiseAbs().maxCoeff()).normalized(); }
  bool operator==(const TurnTable&) const = default;
};

enum class BodyShape { sphere, rod, tetrahedron, cube, box, mesh, molecule };

struct BodyTable {
  TablePlace place;
  std::string name, from_stage;
  BodyShape shape = BodyShape::sphere;
  double length = 0, edge = 0;
  Vec3 size = Vec3::Zero();
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;          // indices from 1
  std::optional<std::vector<std::vector<int>>> edges;
  std::string molecule;
  std::optional<double> rounding_diameter;
  Vec3 position = Vec3::Zero();
  std::optional<double> mass, density;
  std::optional<std::vector<double>> inertia;
  std::optional<TurnTable> rotation;
  bool operator==(const BodyTable&) const = default;
};

/// Particles that a body carries.
struct GlueTable {
  TablePlace place;
  std::string group, body;
  bool operator==(const GlueTable&) const = default;
};

void describe(Keys& keys, TurnTable& t);
/// Also of the table that it is in.
void check(std::optional<TurnTable>& turn, TablePlace& of, Mistakes& mistakes);
void describe(Keys& keys, BodyTable& t);
void describe(Keys& keys, GlueTable& t);

}  // namespace elamin
