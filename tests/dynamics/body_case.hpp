#pragma once
// A case of data/polyhedra as a model, with LAMMPS's rules.
#include "laws/rounded/lammps_case.hpp"
#include "model/model.hpp"

namespace elamin {

inline Model model_of_bodies(const ReferenceCase& c) {
  Model m;
  m.start = State(Field(3, 0));
  const auto n = static_cast<Eigen::Index>(c.bodies.size());
  m.shapes = c.shapes;
  m.body_velocity.resize(3, n), m.angular_momentum.resize(3, n);
  std::map<int, std::vector<int>> of_type;
  std::vector<int> all;
  for (int k = 0; k < n; ++k) {
    const ReferenceBody& b = c.bodies[k];
    m.bodies.push_back({k, k + 1, b.type, b.mass, b.inertia});
    m.start.bodies.push_back(c.body(k).pose);
    m.body_velocity.col(k) = b.v, m.angular_momentum.col(k) = b.L;
    of_type[b.type].push_back(k), all.push_back(k);
  }
  for (const auto& row : c.settings()["pair_coeff"]) {
    RoundedPair t;
    t.bodies = {of_type[row[0]], of_type[row[1]]};
    t.formulation = RoundedFormulation::lammps;
    t.kernel = {row[2], row[3], c.setting("cutoff"), RoundedKernel::Form::coded};
    t.damping = {c.setting("c_n"), c.setting("c_t"), c.setting("mu")};
    t.unit_area = c.setting("delta_ua");
    m.rounded.push_back(t);
  }
  if (c.settings().contains("walls"))
    for (const auto& words : c.settings()["walls"]) {
      const LammpsWall w = lammps_wall(words.get<std::string>());
      for (const double plane : {w.lo, w.hi}) {
        if (!std::isfinite(plane)) continue;
        Wall wall;
        wall.region.shape = Shape::plane;
        wall.region.center = plane * Vec3::Unit(w.axis), wall.region.normal = (plane == w.lo ? 1 : -1) * Vec3::Unit(w.axis);
        wall.bodies = all, wall.lammps = true;
        wall.kernel.normal = w.stiffness, wall.body_damping = {w.normal_damping, w.tangential_damping};
        m.walls.push_back(wall);
      }
    }
  if (c.settings().contains("gravity")) {
    Gravity g;
    g.bodies = all, g.acceleration = gravity_of(c);
    m.gravity.push_back(g);
  }
  return m;
}

}  // namespace elamin
