#pragma once
// What has no fast way of its own: rest angles, pressures, angles that share an edge's end with another one.
#include "dynamics/columns.hpp"
#include "dynamics/edge_order.hpp"
#include "energy/element_group.hpp"

#include <memory>

namespace elamin {

/// Forces of the bonds and angles that an EdgeOrder left out and of the pressures, by way of the groups of the energy.
class OtherForces {
 public:
  OtherForces(const Model& model, const EdgeOrder& order, double load_factor);
  static bool needed(const Model& model, const EdgeOrder& order) {
    return !order.bonds.empty() || !order.angles.empty() || !model.pressures.empty();
  }
  void add(const Columns& x, Rows& force);

 private:
  Model part_;                                  // the model with nothing but these bonds, angles and pressures
  std::vector<std::unique_ptr<ElementGroup>> groups_;
  State state_;
  std::vector<double> value_, gradient_;
};

}  // namespace elamin
