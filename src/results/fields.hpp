#pragma once
// What a state is like inside: forces, strains and moments of every bond and angle, energies and contact forces of every particle.
#include "energy/energy.hpp"
#include "model/model.hpp"
#include "results/table.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace elamin {

// Forces and moments per length in a sheet, from the bonds and hinges of its lattice.

struct AngleField;
struct BondField;

/// Stress resultants at a particle of a sheet, components 11, 22, 12 in the axes of the sheet as it was built (e1, e2 of its frame; of a
/// cylinder around and along the axis), which turn with it. Lengths are those of now.
///   N   mean over the triangles of the lattice beside the particle of  N = 1/A Σ ½ T r t tᵀ, the sum over the three bonds of the triangle,
///       of which half is its; A its area, T, r and t tension, length and direction of a bond [force/length]. Negative: compression
///   M   M = 1/A Σ m ℓ t tᵀ, the sum over the hinges that the particle is the middle of; A the area of its cell, twice the mean of the
///       triangles beside it; ℓ and t length and direction of a hinge, m the part of its moment that turns the sheet towards its
///       normal [force]. Positive: the sheet bends towards the side of its normal, e1 × e2
/// In a uniform state N is the force across any line per length, whatever the strain; at edges too, whose bonds bear what is within and as
/// much beyond: n rows of particles are a strip as wide as n rows of the lattice.
struct StressResultants {
  bool known = false;          // the particle is of a sheet, with a triangle beside it
  Vec3 N = Vec3::Zero(), M = Vec3::Zero();
};

/// The largest and the smallest eigenvalue of a symmetric tensor 11, 22, 12.
std::array<double, 2> principal(const Vec3& tensor);

/// Those of every particle; empty where the model has no sheet.
std::vector<StressResultants> stress_resultants(const Model& model, const State& state, const std::vector<BondField>& bonds,
                                                const std::vector<AngleField>& angles);

struct BondField {
  double length = 0;            // r [length]
  double strain = 0;            // (r − r₀)/r₀
  double tension = 0;           // N = ∂U/∂r [force]; negative: compression
};

/// See CosineAngle::bending. Angle, curvature and moment: in a plane with the sign of a rotation about its normal from the first bond to the
/// second, else that of a rotation further away from straight.
struct AngleField {
  double angle = 0;             // φ [rad]; 0: straight
  double curvature = 0;         // φ over the mean length of the two bonds [1/length]
  double moment = 0;            // M = ∂U/∂φ = −∂U/∂θ [force·length]
  Vec3 moment_vector = Vec3::Zero();   // M about the axis of the rotation: that of what is behind the angle on what is before it
};

struct Fields {
  std::vector<BondField> bonds;        // of Model::bonds
  std::vector<AngleField> angles;      // of Model::angles
  Vector energy;                       // of particles and bodies (see model/entities.hpp), see Energy::shares
  Field contact_force;                 // 3 × the same: sum of the forces of all contacts and walls on each [force]; cohesion is not in it
  std::vector<StressResultants> sheets;   // of every particle; empty where there is no sheet
};

/// Those of all bonds and of all angles of a state, and the contact forces of everything that its contacts have on it.
std::vector<BondField> bond_fields(const Model& model, const State& state);
std::vector<AngleField> angle_fields(const Model& model, const State& state);
Field contact_forces(const Model& model, const std::vector<Touch>& touches);

/// The fields of a state at its load factor; touches: its contacts, see Energy::touches.
Fields fields_at(Energy& energy, const State& state, const std::vector<Touch>& touches);

/// Writes the fields as tables, each to the file of its end. ".particles.csv": id, kind ("particle" or "body"), x, y, z, radius (of a
/// body: bounding), energy, fx, fy, fz (contact force), and where there are sheets N11, N22, N12, M11, M22, M12 (empty beside them, see
/// StressResultants); ".bonds.csv": first, second (ids), length, strain, tension; ".angles.csv": first, middle, third, turn, curvature, moment,
/// mx, my, mz; ".walls.csv", where the walls are at the load factor: name, shape, x, y, z (a plane's point, the centre or a point of the
/// axis), nx, ny, nz (normal or axis), xlo … zhi (block), lo, hi (ends along the axis, empty: infinite), radius_lo, radius_hi, open. The
/// last three only where there are any. Throws OutputError if one cannot be written.
void write_fields(const std::function<std::string(const char* end)>& file, const Model& model, const State& state, const Fields& fields);

}  // namespace elamin
