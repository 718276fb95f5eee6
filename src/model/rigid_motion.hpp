#pragma once
// Which rigid motions the supports leave free, by name.
#include "model/model.hpp"

#include <array>

namespace elamin {

/// A rigid velocity of some particles and bodies, t + ω × (x − x̄), of turns ℓ ω (see Kinematics), that moves no prescribed
/// coordinate.
struct RigidMotion {
  std::string name;               // "translation of 'column' along x", "rotation of 'column' about z through (0, 0, 0)"
  bool translation = false;
  int particle = 0;               // or body: the first entity of the part that moves, see model/entities.hpp
  std::vector<int> sites;         // of the part, ascending: particles, and of bodies the place and the turn
  Field part_velocity;            // theirs, 3 × as many
  // Of more than a single particle: the part's name, its middle x̄ and size, t and the size times ω.
  std::string part = {};
  Vec3 mid = Vec3::Zero();
  double size = 0;
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();

  /// Of all sites (3 × count, particles first), zero outside of the part.
  Field velocity_field(int count) const;
};

/// The rigid motions of every part that is glued together (connected by bonds and angles, or carried by a body), at the given
/// state, that the supports leave free. Motions that move nothing, as turning a straight row about its own line, do not count;
/// a body turns about any. `also`: pairs of entities that hold each other as if glued, as contacts in force do.
std::vector<RigidMotion> free_rigid_motions(const Model& model, const State& state, const std::vector<std::array<int, 2>>& also = {});

/// The motions of one part that these combinations (as many rows as there are motions of it) span, named like any.
std::vector<RigidMotion> combined(const std::vector<RigidMotion>& motions, const Eigen::MatrixXd& combinations);

/// The parts themselves: for every entity the number of its part, from 0 in the order of the first one.
std::vector<int> connected_parts(const Model& model, const std::vector<std::array<int, 2>>& also = {});

}  // namespace elamin
