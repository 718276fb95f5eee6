#pragma once
// Rigid bodies in velocity Verlet, as LAMMPS has it with fix nve/body.
#include "core/error.hpp"
#include "dynamics/body_forces.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/inverse_mass.hpp"
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

// The bodies' part of a step, beside the particles'.

/// The particles of the same engine: positions, velocities, forces with resistance, drag γ.
struct MovingParticles {
  Columns &x, &v, &f;
  const std::vector<double>& drag;
};

/// Moves the bodies and what they carry. Within a step: start() or the previous finish(), place(), Forces::prepare(), the particles'
/// forces into f, finish(). A carried particle has the velocity of its place; what it feels acts on its body.
class BodySteps {
 public:
  BodySteps(const Model& model, const Kinematics& kinematics, const Motion& start, double timestep, Forces& forces, MovingParticles particles);

  /// Puts what forces see of bodies and carried particles where they are; the largest |v|² with which one of the latter moved.
  double carry();
  /// After the first forces; the power that is taken out: that of carried particles' resistance is with the particles.
  double look();
  /// The first kick of a step and the drift.
  void start();
  /// Driven bodies to where they are after so long; then carry().
  double place(double time);
  /// The second kick; unless it is the last step, the first kick and the drift of the next. Returns the power taken out at the whole
  /// step, of carried particles what the half step's velocities had wrong.
  double finish(bool last);

  bool driven() const { return bodies_.driven(); }
  bool finite() const;
  double work_rate() const { return bodies_.work_rate(wrench_); }
  double kinetic() const { return bodies_.kinetic(places()); }
  void write(Motion& motion) const;
  void carry(Archive& archive);

 private:
  BodyPlaces& places() const { return forces_.places(); }
  void gather();
  double power() const;
  Vec3 torque_at(int particle) const;

  const Model& model_;
  double dt_;
  Forces& forces_;
  MovingParticles at_;
  MovingBodies bodies_;
  std::vector<Wrench> wrench_;                  // on every body with what it carries, at the last whole step
};

}  // namespace elamin
