#pragma once
// What a state is like inside: forces, strains and moments of every bond and angle, energies and contact forces of every particle.
#include "energy/energy.hpp"
#include "results/stress_resultants.hpp"
#include "results/table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace elamin {

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

/// The fields as tables, each with the end of its file's name. ".particles.csv": id, kind ("particle" or "body"), x, y, z, radius (of a
/// body: bounding), energy, fx, fy, fz (contact force), and where there are sheets N11, N22, N12, M11, M22, M12 (empty beside them, see
/// StressResultants); ".bonds.csv": first, second (ids), length, strain, tension; ".angles.csv": first, middle, third, turn, curvature, moment,
/// mx, my, mz; ".walls.csv", where the walls are at the load factor: name, shape, x, y, z (a plane's point, the centre or a point of the
/// axis), nx, ny, nz (normal or axis), xlo … zhi (block), lo, hi (ends along the axis, empty: infinite), radius_lo, radius_hi, open. The
/// last three only where there are any.
std::vector<std::pair<std::string, Table>> field_tables(const Model& model, const State& state, const Fields& fields);

}  // namespace elamin
