#pragma once
// A plate or shell: the triangular lattice, bonds between nearest neighbours, angles along its three directions.
#include "model/model.hpp"

#include <array>
#include <string>
#include <vector>

namespace elamin {

/// Frame (e1, e2, n) of the normal: see frame_of. Rows of the lattice run at lattice_angle against e1, towards e2.
///   rectangle  from center − (lx/2) e1 − (ly/2) e2, a lattice point, to the opposite corner
///   circle     around center, a lattice point
///   cylinder   a sheet with the sides e1 and n rolled about the axis n through center, e1 around: at the lower end −h/2 a
///              lattice point in the direction e1; the lattice is turned and scaled so that it closes (see rolled)
/// Lattice points within, edges included to 1e-9 of the spacing, are particles: row after row, along each ascending.
struct Sheet {
  enum class Shape { rectangle, circle, cylinder };
  std::string name;
  Shape shape = Shape::rectangle;
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();   // normal: of any length but zero
  std::array<double, 2> size{};                    // rectangle: sides along e1 and e2 [length]
  double radius = 0, height = 0;                   // circle: radius; cylinder: both
  double lattice_angle = 0;                        // [rad]; a multiple of 30° to the rounding of radians is exactly that
  double spacing = 0;
  double rest_length = 0;                          // 0: as built: the spacing; of a cylinder the chords
  double diameter = 0, density = 0;                // of the particles; density 0: not given
  double youngs_modulus = 0;                       // 0: not known
  double bond_stiffness = 0, angle_stiffness = 0;
  bool as_built = false;                           // angles at rest as built; of a cylinder an angle type a direction
  double rest = pi;            // else: rest angle [rad]
};

/// How a cylinder's lattice closes: once around is n1 steps along a row and n2 along the direction 60° from it.
/// It is the lattice vector nearest to 2πR/spacing at −lattice_angle against the rows; `spacing` is the lattice's own,
/// 2πR/√(n1² + n1 n2 + n2²). With two spacings around or fewer a particle meets itself: closes is false.
struct Rolled {
  int n1 = 0, n2 = 0;
  double spacing = 0;
  bool closes = false;
};
Rolled rolled(const Sheet& sheet);

/// How many particles add_sheets makes of it, without making them; the largest int for more than that, or than 2e7 rows or
/// 1e7 spacings around, or for sizes that are no numbers; 0 for a cylinder that does not close.
int sheet_particles(const Sheet& sheet);

/// Appends the sheets, each with sheet_particles > 0: particles to about 1e-30, ids, type and molecule as of a beam, all
/// nearest-neighbour bonds, angles over all straight triples of the lattice, and the Structure. Types: one of bonds and
/// one of angles; of a cylinder three where they are as built, in the order of lattice_directions.
void add_sheets(Model& model, const std::vector<Sheet>& sheets);

// The triangles of a lattice, as a surface.

/// Every three particles of a structure that are bonded to each other, counterclockwise as built about `normal`; of a tube about the
/// direction away from the axis along `normal` through `center`.
std::vector<std::array<int, 3>> lattice_triangles(const Model& model, const Structure& structure, const Vec3& center, const Vec3& normal, bool tube);

/// The edges that belong to one triangle alone, in its direction.
std::vector<std::array<int, 2>> rim_edges(const std::vector<std::array<int, 3>>& triangles);

}  // namespace elamin
