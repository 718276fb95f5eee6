#include "dynamics/other_forces.hpp"

#include "energy/groups.hpp"

#include <algorithm>

namespace elamin {

OtherForces::OtherForces(const Model& model, const EdgeOrder& order, double load_factor) : part_(model), state_(model.start) {
  part_.bonds.clear(), part_.angles.clear();
  for (const int b : order.bonds) part_.bonds.push_back(model.bonds[b]);
  for (const int a : order.angles) part_.angles.push_back(model.angles[a]);
  state_.tail.setZero();
  state_.load_factor = load_factor;
  for (auto& group : {bond_group, angle_group, pressure_group}) {
    std::unique_ptr<ElementGroup> g = group(part_);
    if (g->elements() > 0) groups_.push_back(std::move(g));
  }
  for (const auto& g : groups_) {
    value_.resize(std::max<std::size_t>(value_.size(), g->elements()));
    gradient_.resize(std::max<std::size_t>(gradient_.size(), std::size_t(g->elements()) * g->gradient_size()));
  }
}

void OtherForces::add(const Columns& x, Rows& force) {
  x.copy_to(state_.position);
  for (const auto& group : groups_) {
    group->derivatives(state_, nullptr, value_.data(), gradient_.data(), nullptr);
    const double* g = gradient_.data();
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e)) force.row[p] -= Lanes(g[0], g[1], g[2], 0), g += 3;
  }
}

}  // namespace elamin
