#include "results/mode.hpp"

#include <algorithm>
#include <limits>

namespace elamin {
namespace {

/// The smallest diameter, or of particles without any the shortest bond at rest.
double size_of(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const double d : model.diameter)
    if (d > 0) least = std::min(least, d);
  if (least < std::numeric_limits<double>::infinity()) return least;
  for (const BondType& b : model.bond_types)
    if (b.rest_length > 0) least = std::min(least, b.rest_length);
  return least < std::numeric_limits<double>::infinity() ? least : 0;
}

}  // namespace

State moved_along(const Mode& mode, const Model& model, const State& state) {
  State moved = state;
  const double most = mode.shape.size() > 0 ? mode.shape.colwise().norm().maxCoeff() : 0;
  if (!(most > 0)) return moved;
  const double scale = 0.1 * size_of(model) / most;
  for (int i = 0; i < model.particles(); ++i)
    moved.set(i, state.at(i) + ExactVector{scale * mode.shape.col(i), Vec3::Zero()});
  return moved;
}

}  // namespace elamin
