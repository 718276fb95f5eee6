#include "energy/step_limits.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace elamin {

namespace {

std::string name_of(const Model& model, int particle) {
  std::string name = "particle " + std::to_string(model.id[particle]);
  for (const Structure& s : model.structures)
    if (particle >= s.first && particle < s.first + s.count) name += " of '" + s.name + "'";
  return name;
}

}  // namespace

double distortion(const Energy& energy, const State& state, const Vector& step, double load_change) {
  Field s = energy.kinematics().extend(step);
  if (load_change != 0 && energy.kinematics().driven())
    for (Eigen::Index p = 0; p < s.cols(); ++p) s.col(p) += load_change * energy.kinematics().drive(static_cast<int>(p));
  double largest = 0;
  for (const Bond& b : energy.model().bonds) {
    const auto [i, j] = b.particles;
    const double length = (state.at(j) - state.at(i)).hi.norm();
    if (length > 0) largest = std::max(largest, (s.col(j) - s.col(i)).norm() / length);
  }
  return largest;
}

double movement(const Energy& energy, const Vector& step) {
  const Field s = energy.kinematics().extend(step);
  const std::vector<double>& diameter = energy.model().diameter;
  double largest = 0;
  for (Eigen::Index p = 0; p < s.cols(); ++p)
    if (diameter[p] > 0) largest = std::max(largest, s.col(p).norm() / diameter[p]);
  return largest;
}

double extent(const Model& model) {
  if (model.contacts.empty() && model.walls.empty()) return std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box;
  for (int p = 0; p < model.particles(); ++p)
    for (const double r : {-model.diameter[p] / 2, model.diameter[p] / 2})
      box.extend(Vec3(model.start.position.col(p) + Vec3::Constant(r)));
  for (const Wall& w : model.walls) {
    const Region& r = w.region;
    const Vec3 x0 = model.start.position.col(0);
    if (r.shape == Shape::block) box.extend(r.lo), box.extend(r.hi);
    else if (r.shape == Shape::plane) box.extend(Vec3(x0 - r.normal * r.normal.dot(x0 - r.center)));
    else box.extend(Vec3(r.center - Vec3::Constant(r.radius))), box.extend(Vec3(r.center + Vec3::Constant(r.radius)));
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

std::string escaped(const Model& model, const State& state, double far) {
  for (int p = 0; p < model.particles(); ++p)
    if ((state.position.col(p) - model.start.position.col(p)).cwiseAbs().maxCoeff() > far) return name_of(model, p);
  return "";
}

std::string falling(const Energy& energy) {
  for (const int d : energy.idle())
    if (energy.gradient()[d] != 0) return name_of(energy.model(), energy.kinematics().site_of(d));
  return "";
}

}  // namespace elamin
