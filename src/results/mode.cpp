#include "results/mode.hpp"

#include "model/entities.hpp"

#include <algorithm>

namespace elamin {
namespace {

/// The smallest size, or of particles without any the shortest bond at rest.
double size_of_all(const Model& model) {
  if (const double least = smallest_size(model); least > 0) return least;
  double least = infinity;
  for (const BondType& b : model.bond_types)
    if (b.rest_length > 0) least = std::min(least, b.rest_length);
  return least < infinity ? least : 0;
}

}  // namespace

Eigen::Matrix<double, 6, 1> body_motion(const Model& model, const Field& sites, int body) {
  const int place = model.particles() + 2 * body;
  Eigen::Matrix<double, 6, 1> v;
  v << sites.col(place), sites.col(place + 1) / (size_of(model, model.particles() + body) / 2);
  return v;
}

State moved_along(const Mode& mode, const Model& model, const State& state) {
  State moved = state;
  const double most = mode.shape.size() > 0 ? mode.shape.colwise().norm().maxCoeff() : 0;
  if (!(most > 0)) return moved;
  const double scale = 0.1 * size_of_all(model) / most;
  for (int i = 0; i < model.particles(); ++i)
    moved.set(i, state.at(i) + ExactVector{scale * mode.shape.col(i), Vec3::Zero()});
  for (std::size_t b = 0; b < moved.bodies.size(); ++b) {
    const Eigen::Matrix<double, 6, 1> v = scale * body_motion(model, mode.shape, static_cast<int>(b));
    moved.bodies[b] = elamin::moved(state.bodies[b], v.head<3>(), v.tail<3>());
  }
  for (const Glued& g : model.glued) {
    const Pose& pose = moved.bodies[g.body];
    moved.set(g.particle, pose.position + ExactVector{pose.rotation * g.arm, Vec3::Zero()});
  }
  return moved;
}

}  // namespace elamin
