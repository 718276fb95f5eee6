#pragma once
// What LAMMPS's rules give for a reference case: all pairs, walls and gravity.
#include "laws/rounded/reference_bodies.hpp"
#include "laws/rounded/rigid_step.hpp"

namespace elamin {

inline LammpsRules lammps_rules(const ReferenceCase& c, std::size_t i, std::size_t j) {
  return {c.kernel(i, j), c.setting("c_n"), c.setting("c_t"), c.setting("mu"), c.setting("delta_ua")};
}

/// "k_n c_n c_t|NULL xplane|yplane|zplane lo|NULL hi|NULL"
inline LammpsWall lammps_wall(const std::string& words) {
  std::istringstream in(words);
  std::string kn, cn, ct, plane, lo, hi;
  in >> kn >> cn >> ct >> plane >> lo >> hi;
  LammpsWall wall{std::stod(kn), std::stod(cn), std::stod(cn) / 2, plane[0] - 'x'};
  if (ct != "NULL") wall.tangential_damping = std::stod(ct);
  if (lo != "NULL") wall.lo = std::stod(lo);
  if (hi != "NULL") wall.hi = std::stod(hi);
  return wall;
}

struct LammpsBodies {
  std::vector<RigidState> state;
  std::vector<RigidMass> mass;
};

inline LammpsBodies at_start(const ReferenceCase& c) {
  LammpsBodies all;
  for (std::size_t k = 0; k < c.bodies.size(); ++k) {
    const ReferenceBody& b = c.bodies[k];
    all.state.push_back({c.body(k).pose, b.v, b.L});
    all.mass.emplace_back(b.mass, b.inertia);
  }
  return all;
}

/// Forces and torques of pairs and walls; gravity apart.
inline Wrenches lammps_forces(const ReferenceCase& c, const LammpsBodies& all) {
  const std::size_t n = c.bodies.size();
  Wrenches w(n);
  std::vector<RoundedBody> body;
  std::vector<BodyMotion> motion;
  const auto add = [&w](std::size_t k, const Wrench& on) { w.forces[k] += on.force, w.torques[k] += on.torque; };
  for (std::size_t k = 0; k < n; ++k) {
    body.push_back({&c.shapes[k], all.state[k].pose});
    motion.push_back(all.state[k].motion(all.mass[k]));
    if (c.settings().contains("walls"))
      for (const auto& words : c.settings()["walls"])
        add(k, lammps_wall(words.get<std::string>()).on(body[k], motion[k]));
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const LammpsPair pair = lammps_rules(c, i, j).pair(body[i], body[j], motion[i], motion[j]);
      w.energy += pair.energy;
      add(i, pair.on[0]), add(j, pair.on[1]);
    }
  return w;
}

/// Of a setting "g vector x y z": g times the unit vector.
inline Vec3 gravity_of(const ReferenceCase& c) {
  if (!c.settings().contains("gravity")) return Vec3::Zero();
  std::istringstream in(c.settings()["gravity"].get<std::string>());
  std::string word;
  double g = 0;
  Vec3 direction;
  in >> g >> word >> direction[0] >> direction[1] >> direction[2];
  return g * direction.normalized();
}

}  // namespace elamin
