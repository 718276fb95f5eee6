#pragma once
// The bodies' part of a step, beside the particles'.
#include "dynamics/forces.hpp"
#include "dynamics/moving_bodies.hpp"

namespace elamin {

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
