#pragma once
// What rigid bodies, and bodies and particles, do to each other while they move; walls, weights, loads and drag on bodies.
#include "dynamics/pair_forces.hpp"
#include "energy/body_neighbours.hpp"
#include "laws/rounded/friction.hpp"
#include "laws/rounded/rotation.hpp"
#include "laws/rounded/wall.hpp"

namespace elamin {

/// Where bodies are and how they move.
struct BodyPlaces {
  std::vector<Pose> pose;
  std::vector<BodyMotion> motion;
};

/// Forces at a load factor that stays; walls stand still. Pairs and walls of potentials have the damping and friction of
/// RoundedFriction, a wall's at its contacts; those that follow LAMMPS's rules what these say. Drag is −γ v of a body's position, no
/// torque. What a particle feels is a force, friction besides a torque on its spin.
class BodyForces {
 public:
  BodyForces(const Model& model, double load_factor);

  /// Whether any particle is in a table with a body; whether such a pair damps, rubs.
  bool meets_particles() const { return !met_.empty(); }
  bool damps_particles() const { return damps_particles_; }
  bool rubs_particles() const { return rubs_particles_; }
  /// Whether anything resists.
  bool damps() const { return damps_; }

  /// With the bodies there; particles as `movement` has them. What pushes particles is added to `pushes`.
  void find(const BodyPlaces& places, const Movement& movement, Pushes& pushes);
  /// Of the last find(): every force on each body, torques about the positions; and of these what resists the motion.
  const std::vector<Wrench>& on() const { return on_; }
  const std::vector<Wrench>& resistance() const { return resistance_; }
  void carry(Archive& archive);

 private:
  void list_pairs();
  struct Pair { int i, j, table; double cutoff; };   // beyond which they feel nothing
  struct Table { bool lammps, closest, damps; RoundedFriction friction; };
  struct At { int wall; bool damps; RoundedWall law; RoundedFriction friction; std::vector<LammpsWall> lammps; };
  struct Pointed { int body; Vec3 force, arm; };
  struct Twisted { int body; double scale; RotationTorque torque; };

  void meet(Pushes& pushes);
  void touch_walls();
  void put(int entity, const Wrench& elastic, const Wrench& resistance, Pushes& pushes);

  const Model& model_;
  BodyNeighbours neighbours_;
  std::vector<Table> tables_;
  std::vector<Pair> pairs_;
  std::vector<At> walls_;
  std::vector<int> met_;                       // particles that bodies may meet
  std::vector<Wrench> loads_;                  // weights and forces at the positions
  std::vector<Pointed> pointed_;
  std::vector<Twisted> twisted_;
  std::vector<double> drag_;
  bool damps_ = false, damps_particles_ = false, rubs_particles_ = false;
  State state_;
  std::vector<BodyMotion> motion_;             // of entities
  std::vector<Wrench> on_, resistance_;
  std::vector<RoundedContact> contacts_;
  std::vector<RoundedWallTouch> touches_;
};

}  // namespace elamin
