#pragma once
// Rigid bodies in velocity Verlet, as LAMMPS has it with fix nve/body.
#include "core/error.hpp"
#include "dynamics/body_forces.hpp"
#include "dynamics/body_mass.hpp"
#include "dynamics/motion.hpp"
#include "energy/kinematics.hpp"
#include "laws/rounded/rigid_step.hpp"

namespace elamin {

/// The steps of kick and drift (see rigid_step.hpp) of every body, about the centre of mass that it has with what it carries, or about
/// its position where that is held whole. Held coordinates of the place go with their support's velocity; held turns do not turn, a body
/// with one free turn spins about that axis alone.
class MovingBodies {
 public:
  /// From the motion, which must have poses, velocities and angular momenta of all bodies.
  MovingBodies(const Model& model, const Kinematics& kinematics, const Motion& start, double timestep);

  /// Why bodies cannot move, a sentence each.
  static std::vector<Mistake> mistakes(const Model& model, const Kinematics& kinematics);

  bool any() const { return !bodies_.empty(); }
  bool driven() const { return driven_; }
  /// v += dt/2 F/m, L += dt/2 T; wrenches about the positions, on bodies with what they carry.
  void kick(const std::vector<Wrench>& on);
  void drift();
  /// Driven coordinates to where they are after so long.
  void place_driven(double time);
  /// The poses, and how the positions move and the bodies spin, now.
  void show(BodyPlaces& places) const;
  /// −Σ F·V over the driven coordinates.
  double work_rate(const std::vector<Wrench>& on) const;
  /// Of the bodies, and of the spins of what they carry.
  double kinetic(const BodyPlaces& now) const;
  /// State and velocities of the bodies, angular momenta without what they carry.
  void write(const BodyPlaces& now, Motion& motion) const;
  void carry(Archive& archive);

 private:
  struct One {
    RigidState state;                          // about the point of reference
    RigidMass mass;
    Vec3 offset;                               // of that from the position, in the frame of the body
    std::array<bool, 3> free, turns;
    Vec3 start, velocity;                      // of the held coordinates
    bool plain;                                // the point is the position, all turns are free, nothing is carried
    Mat3 own_inertia;
    double own_mass, carried_inertia;             // ½ ω² times the latter: the spin of carried balls
  };

  std::vector<One> bodies_;
  double dt_;
  bool driven_ = false;
};

}  // namespace elamin
