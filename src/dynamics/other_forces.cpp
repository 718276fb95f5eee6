#include "dynamics/other_forces.hpp"

#include "energy/groups.hpp"

#include <algorithm>

namespace elamin {

OtherForces::OtherForces(const Model& model, const EdgeOrder& order, double load_factor) : part_(model), state_(model.start) {
  part_.bonds.clear(), part_.angles.clear(), part_.glued.clear();   // a force on a glued particle is one on the particle
  for (const int b : order.bonds) part_.bonds.push_back(model.bonds[b]);
  for (const int a : order.angles) part_.angles.push_back(model.angles[a]);
  state_.low.setZero();
  state_.load_factor = load_factor;
  const Kinematics kinematics(part_);
  groups_.push_back(bond_group(part_, kinematics).free);
  groups_.push_back(angle_group(part_, kinematics).free);
  groups_.push_back(pressure_group(part_));
  groups_.push_back(sheet_pressure_group(part_));
  for (const auto& g : groups_) {
    value_.resize(std::max<std::size_t>(value_.size(), g->elements()));
    gradient_.resize(std::max<std::size_t>(gradient_.size(), std::size_t(g->elements()) * g->gradient_size()));
  }
}

void OtherForces::add(const Columns& x, Rows& force) {
  x.copy_to(state_.position);
  for (const auto& group : groups_) {
    group->derivatives(state_, {}, value_.data(), gradient_.data(), nullptr);
    const double* g = gradient_.data();
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e)) force.row[p] -= Lanes(g[0], g[1], g[2], 0), g += 3;
  }
}

}  // namespace elamin
