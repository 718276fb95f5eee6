#pragma once
// Where something is inside or outside of: LAMMPS's regions, for walls and for choosing groups.
#include "core/exact.hpp"

#include <array>
#include <string>
#include <vector>

namespace elamin {

enum class Shape { plane, block, cylinder, sphere, cone };
constexpr std::array<const char*, 5> shape_names{"plane", "block", "cylinder", "sphere", "cone"};
inline const char* name_of(Shape shape) { return shape_names[static_cast<int>(shape)]; }
/// The names of Region::open: of a block, of a cylinder or a cone.
constexpr std::array<const char*, 6> block_face_names{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
constexpr std::array<const char*, 3> round_face_names{"lo", "hi", "side"};

/// A plane (the half-space that the normal points into), a block, a cylinder or a cone (a frustum) along x, y or z between
/// lo and hi, or a sphere. Members that a shape does not have are not read.
struct Region {
  Shape shape = Shape::plane;
  Vec3 center = Vec3::Zero();                  // plane: a point of it; cylinder, cone: of the axis (along it: not read); sphere
  Vec3 normal = Vec3::UnitZ();                 // plane: a unit vector
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();   // block
  int axis = 2;                                // cylinder, cone: 0, 1, 2 for x, y, z
  double axial_lo = -infinity;   // cylinder, cone: ends along the axis
  double axial_hi = infinity;
  double radius = 0;                           // cylinder, sphere
  double radius_lo = 0, radius_hi = 0;         // cone: at axial_lo and axial_hi
  /// Faces that are not there. block: xlo, xhi, ylo, yhi, zlo, zhi; cylinder, cone: lo, hi, side.
  std::array<bool, 6> open{};
  ExactVector displacement;                    // of the whole region from the place that the members above give, with all digits

  /// Whether x is inside (on the surface: inside).
  bool contains(const Vec3& x) const { return contains(ExactVector{x, Vec3::Zero()}); }
  bool contains(const ExactVector& x) const;
  /// A lower bound of the distance from x to the nearest closed face, in doubles, with their rounding subtracted [length]; the distance itself to rounding, but for
  /// cones, where it may be less. Infinity where no face is closed.
  double least_distance(const Vec3& x) const;
  /// The names of the faces that are not there.
  std::vector<std::string> open_faces() const {
    std::vector<std::string> names;
    for (int k = 0; k < (shape == Shape::block ? 6 : 3); ++k)
      if (open[k]) names.push_back(shape == Shape::block ? block_face_names[k] : round_face_names[k]);
    return names;
  }
  bool any_open() const { return open[0] || open[1] || open[2] || open[3] || open[4] || open[5]; }
  /// The same region moved by d and with its radius (of a cone: both) larger by `growth`.
  Region moved(const Vec3& d, double growth) const;
  /// The same, but d is added to `displacement`, which keeps its digits: in the members of a region far from the origin they would be rounded off.
  Region moved_exactly(const ExactVector& d, double growth) const;
  /// The same region with its members moved by `displacement`, rounded, and no displacement left.
  Region rounded() const;
  bool operator==(const Region&) const = default;
};

}  // namespace elamin
