#pragma once
// The tables of structures, as plain numbers, and where tables stand in the file.
#include "core/place.hpp"
#include "core/types.hpp"
#include "laws/section.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// Where a table and its keys stand, for messages that come after reading. It is not part of what the file says:
/// two tables that say the same are equal wherever they stand.
struct TablePlace : Place {
  std::string key;                              // what `--set` calls the table: "beam.column", "support.2", "path"
  std::map<std::string, Place> keys;            // of those that are written
  bool broken = false;                          // a mistake was found in it
  bool operator==(const TablePlace&) const { return true; }
};

/// The rest angle of a structure's angles: "straight", "as_built", or degrees.
struct Rest {
  bool as_built = false;
  double degrees = 180;
  bool operator==(const Rest&) const = default;
};

enum class Profile { circle, sine };           // of an arch
enum class ClampedEnds { from, to, both };

struct BeamTable {
  TablePlace place;
  std::string name;
  std::string from_stage;                       // there from that stage on; "": from the start
  Section section = Section::cylinder;
  int particles = 0;
  std::optional<Vec3> from, to;                 // either these …
  std::optional<Vec3> center, axis;             // … or these, with spacing …
  std::optional<double> spacing;                // default: the diameter
  std::optional<std::vector<Vec3>> through;     // … or the corners
  std::optional<double> rise, angle;            // of an arch between from and to: its height, or the degrees of the arc
  std::optional<Vec3> toward;                   // the side it rises to; default: in the plane, to the left
  std::optional<Profile> profile;               // of an arch, default a circle
  std::optional<ClampedEnds> clamped;           // ends with a particle beyond, to be held
  double diameter = 0;
  std::optional<double> thickness;              // default: the diameter
  std::optional<double> youngs_modulus;         // needed unless both stiffnesses are given
  std::optional<double> density;
  std::optional<double> bond_stiffness, angle_stiffness, rest_length;
  std::optional<double> axial_stiffness, bending_stiffness;   // EA and EI
  Rest rest;
  bool operator==(const BeamTable&) const = default;
};

struct LoopTable {
  TablePlace place;
  std::string name;
  std::string from_stage;                       // there from that stage on; "": from the start
  Section section = Section::cylinder;
  int particles = 0;
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  double radius = 0;                            // of the circle through the centres
  double diameter = 0;
  std::optional<double> thickness;              // default: the diameter
  std::optional<double> youngs_modulus, density;
  std::optional<double> bond_stiffness, angle_stiffness, rest_length;   // rest length: default the chord
  std::optional<double> axial_stiffness, bending_stiffness;             // EA and EI
  Rest rest;
  bool operator==(const LoopTable&) const = default;
};

enum class SheetShape { rectangle, circle, cylinder };

struct SheetTable {
  TablePlace place;
  std::string name;
  std::string from_stage;                       // there from that stage on; "": from the start
  SheetShape shape = SheetShape::rectangle;
  std::optional<std::array<double, 2>> size;    // rectangle
  std::optional<double> radius, height;         // circle: radius; cylinder: both
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  double lattice_angle = 0;                     // degrees
  double spacing = 0;
  std::optional<double> thickness, diameter;    // default: the spacing
  std::optional<double> youngs_modulus, density;
  std::optional<double> bond_stiffness, angle_stiffness, rest_length;   // rest length: default the spacing
  Rest rest;
  bool operator==(const SheetTable&) const = default;
};

struct GrainsTable {
  TablePlace place;
  std::string name;
  std::string from_stage;                       // there from that stage on; "": from the start
  std::optional<std::vector<Vec3>> positions;   // either these …
  std::string file;                             // … or a CSV file: x,y,z, and a diameter if there is a fourth column
  std::optional<double> diameter;               // needed unless the file has it
  std::optional<double> density;
  bool operator==(const GrainsTable&) const = default;
};

/// A turn by an angle about an axis.
struct TurnTable {
  TablePlace place;
  Vec3 axis = Vec3::UnitZ();                    // of any length but zero
  double angle = 0;                             // degrees
  /// The rotation vector [rad].
  Vec3 vector() const { return angle * pi / 180 * (axis / axis.cwiseAbs().maxCoeff()).normalized(); }
  bool operator==(const TurnTable&) const = default;
};

enum class BodyShape { sphere, rod, tetrahedron, cube, box, mesh, molecule };

/// A rigid body with rounded corners. Lengths are of the core, without the rounding.
struct BodyTable {
  TablePlace place;
  std::string name;
  BodyShape shape = BodyShape::sphere;
  double length = 0, edge = 0;                  // of a rod; of a tetrahedron and a cube
  Vec3 size = Vec3::Zero();                     // of a box
  std::vector<Vec3> vertices;                   // of a mesh
  std::vector<std::vector<int>> faces;          // indices of vertices from 1, counter-clockwise seen from outside
  std::optional<std::vector<std::vector<int>>> edges;   // default: those of the faces
  std::string molecule;                         // LAMMPS's molecule file
  std::optional<double> rounding_diameter;      // of the ball that rounds the core
  Vec3 position = Vec3::Zero();                 // of the origin of the core's frame
  std::optional<double> mass, density;          // one of these, or none
  std::optional<std::vector<double>> inertia;   // with mass, about the centre of mass: ixx, iyy, izz, ixy, ixz, iyz
  std::optional<TurnTable> rotation;
  bool operator==(const BodyTable&) const = default;
};

/// Particles that a body carries.
struct GlueTable {
  TablePlace place;
  std::string group, body;                      // body: a [[body]], or a group of one
  bool operator==(const GlueTable&) const = default;
};

/// Bonds between the particles of two groups that are near each other, and angles over these bonds.
struct ConnectTable {
  TablePlace place;
  std::string from_stage;                       // made as that stage begins, where things are by then; "": as built
  std::array<std::string, 2> between;
  double within = 0;
  std::optional<int> bonds_per_particle;        // of the first group: its nearest ones only; default all
  double bond_stiffness = 0;
  std::optional<double> rest_length;            // default: the distance as built
  std::optional<double> angle_stiffness;        // default: no angles
  Rest rest{true, 180};                         // as built
  bool operator==(const ConnectTable&) const = default;
};

/// What is gone from a stage on.
struct RemoveTable {
  enum class What { particles, bonds, angles };
  TablePlace place;
  std::string group, from_stage;
  What what = What::particles;                  // particles with all that is on them; bonds between them, and angles over these; angles
  bool operator==(const RemoveTable&) const = default;
};

}  // namespace elamin
