#pragma once
// What a rigid body weighs with the particles that it carries.
#include "model/model.hpp"

namespace elamin {

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

}  // namespace elamin
