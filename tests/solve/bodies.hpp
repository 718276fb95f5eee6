#pragma once
// Models of rigid bodies for tests.
#include "energy/energy.hpp"

namespace elamin {

inline Pose pose(const Vec3& x, const Vec3& turned = Vec3::Zero()) { return {{x, Vec3::Zero()}, quaternion(turned)}; }

inline int add_body(Model& m, const CoreMesh& core, double radius, const Pose& at, double mass = 1) {
  m.shapes.push_back(rounded_shape(core, radius));
  const int b = static_cast<int>(m.bodies.size());
  m.bodies.push_back({b, m.particles() + b + 1, 1, mass, Mat3::Identity()});
  m.start.bodies.push_back(at);
  return b;
}

inline std::vector<int> all_bodies(const Model& m) {
  std::vector<int> all(m.bodies.size());
  for (std::size_t b = 0; b < all.size(); ++b) all[b] = static_cast<int>(b);
  return all;
}

/// Every body feels every other one.
inline void add_contacts(Model& m, const RoundedKernel& kernel, RoundedFormulation formulation = RoundedFormulation::multi) {
  RoundedPair t;
  t.bodies = {all_bodies(m), all_bodies(m)};
  t.kernel = kernel, t.formulation = formulation;
  m.rounded.push_back(t);
}

/// A plane for all bodies.
inline Wall& add_plane(Model& m, const Vec3& center, const Vec3& normal, double stiffness, std::string name = "floor") {
  Wall w;
  w.name = std::move(name), w.bodies = all_bodies(m);
  w.region.shape = Shape::plane, w.region.center = center, w.region.normal = normal;
  w.kernel.normal = stiffness;
  m.walls.push_back(w);
  return m.walls.back();
}

inline void add_weight(Model& m, const Vec3& acceleration) {
  Gravity g;
  g.bodies = all_bodies(m), g.acceleration = acceleration;
  m.gravity.push_back(g);
}

inline void hold_bodies(Model& m, std::vector<int> bodies, std::array<bool, 3> places, std::array<bool, 3> turns) {
  Support s;
  s.bodies = std::move(bodies), s.held = places, s.constrained_rotations = turns;
  m.supports.push_back(s);
}

/// A force at a point of a body, scaled by the load factor.
inline void pull(Model& m, int body, const Vec3& force, const Vec3& point = Vec3::Zero()) {
  Load l;
  l.bodies = {body}, l.force = force, l.point = point;
  m.loads.push_back(l);
}

inline Vec3 place(const State& s, int body) { return s.bodies[body].position.hi + s.bodies[body].position.lo; }

}  // namespace elamin
