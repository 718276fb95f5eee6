#pragma once
// The mass of the free dofs at a state.
#include "energy/kinematics.hpp"
#include "model/model.hpp"

namespace elamin {

// What a rigid body weighs with the particles that it carries.

/// Mass, centre of mass and inertia of a body and its glued particles, which are balls of their own masses (density · π d³/6; not
/// given: none): in the frame of the body.
struct BodyMass {
  double mass = 0;
  Vec3 center = Vec3::Zero();                  // from the body's position; exactly 0 if it carries no mass
  Mat3 inertia = Mat3::Zero();                 // about the body's position
  bool loaded = false;                         // whether it carries any mass

  BodyMass(const Model& model, int body) : mass(model.bodies[body].mass), inertia(model.bodies[body].inertia) {
    Vec3 moment = Vec3::Zero();
    for (const Glued& g : model.glued) {
      const double m = model.mass(g.particle), r = model.diameter[g.particle] / 2;
      if (g.body != body || !(m > 0)) continue;
      loaded = true;
      mass += m, moment += m * g.arm;
      inertia += m * about(g.arm) + 0.4 * m * r * r * Mat3::Identity();
    }
    if (loaded) center = moment / mass;
  }

  Mat3 inertia_about_center() const { return loaded ? Mat3(inertia - mass * about(center)) : inertia; }

 private:
  static Mat3 about(const Vec3& a) { return a.squaredNorm() * Mat3::Identity() - a * a.transpose(); }
};

/// M of ½ q̇ᵀ M q̇: of particles diagonal; of a body, in the coordinates (x, ℓθ) of its place and turn, with a = R c the arm of its
/// centre of mass and I its inertia about x, both with what it carries,
///   M = [[m I, −m [a]×/ℓ], [·, R I Rᵀ/ℓ²]].
/// Turns about an axis with no inertia have M⁻¹ = 0, as in RigidMass.
class InverseMass {
 public:
  InverseMass(const Model& model, const Kinematics& kinematics, const State& state);

  /// M^{-1/2} v (dofs).
  Vector root(const Vector& v) const;
  /// The largest velocity that a unit impulse at `arm` from a body's position gives that point, of a particle its place [1/mass].
  double at(int body, const Vec3& arm) const;
  double at(int particle) const;

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  const Kinematics& kinematics_;
  Vector particle_;                            // 1/√m of the dofs of particles
  std::vector<Mat6> root_;                     // of bodies; zero where held
};

}  // namespace elamin
