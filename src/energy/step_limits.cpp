#include "energy/step_limits.hpp"

#include "model/entities.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace elamin {

namespace {

std::string name_of(const Model& model, int entity) {
  std::string name = called(model, entity);
  const bool body = is_body(model, entity);
  const int k = body ? entity - model.particles() : entity;
  for (const Structure& s : model.structures)
    if (const int first = body ? s.first_body : s.first; k >= first && k < first + (body ? s.bodies : s.count)) name += " of '" + s.name + "'";
  return name;
}

}  // namespace

double distortion(const Energy& energy, const State& state, const Vector& step, double load_change) {
  Field s = energy.kinematics().extend(step, state);
  if (load_change != 0 && energy.kinematics().driven())
    for (Eigen::Index p = 0; p < s.cols(); ++p) s.col(p) += load_change * energy.kinematics().drive(static_cast<int>(p));
  double largest = 0;
  for (const Bond& b : energy.model().bonds) {
    const auto [i, j] = b.particles;
    const double length = (state.at(j) - state.at(i)).hi.norm();
    if (length > 0) largest = std::max(largest, (s.col(j) - s.col(i)).norm() / length);
  }
  const Kinematics& kinematics = energy.kinematics();
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    largest = std::max(largest, s.col(kinematics.turn_of(static_cast<int>(b))).norm() / kinematics.lever(static_cast<int>(b)));
  return largest;
}

double movement(const Energy& energy, const Vector& step) {
  const Field s = energy.kinematics().extend(step);
  double largest = 0;
  for (int p = 0; p < s.cols(); ++p)
    if (const double size = energy.kinematics().size(p); size > 0) largest = std::max(largest, s.col(p).norm() / size);
  return largest;
}

double extent(const Model& model) {
  if (model.contacts.empty() && model.walls.empty() && model.rounded.empty()) return std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box = box_of(model, model.start);
  if (box.isEmpty()) return 0;
  for (const Wall& w : model.walls) {
    const Region& r = w.region;
    const Vec3 x0 = model.particles() > 0 ? Vec3(model.start.position.col(0)) : model.start.bodies[0].position.hi;
    if (r.shape == Shape::block) box.extend(r.lo), box.extend(r.hi);
    else if (r.shape == Shape::plane) box.extend(Vec3(x0 - r.normal * r.normal.dot(x0 - r.center)));
    else box.extend(Vec3(r.center - Vec3::Constant(r.radius))), box.extend(Vec3(r.center + Vec3::Constant(r.radius)));
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

std::string escaped(const Model& model, const State& state, double far) {
  for (int p = 0; p < model.particles(); ++p)
    if ((state.position.col(p) - model.start.position.col(p)).cwiseAbs().maxCoeff() > far) return name_of(model, p);
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if ((state.bodies[b].position.hi - model.start.bodies[b].position.hi).cwiseAbs().maxCoeff() > far)
      return name_of(model, model.particles() + static_cast<int>(b));
  return "";
}

std::string falling(const Energy& energy) {
  for (const int d : energy.idle())
    if (energy.gradient()[d] != 0) {
      const int site = energy.kinematics().site_of(d), body = energy.kinematics().body_of(site);
      return name_of(energy.model(), body < 0 ? site : energy.model().particles() + body);
    }
  return "";
}

}  // namespace elamin
