#include "model/entities.hpp"

#include <algorithm>

namespace elamin {

int id_of(const Model& model, int entity) {
  if (is_body(model, entity)) return model.bodies[entity - model.particles()].id;
  return model.id.empty() ? entity + 1 : model.id[entity];
}

std::string called(const Model& model, int entity) {
  const bool body = is_body(model, entity);
  const int k = body ? entity - model.particles() : entity;
  for (const Structure& s : model.structures) {
    const int number = k - (body ? s.first_body : s.first);
    if (s.name.empty() || s.kind == "lammps" || number < 0 || number >= (body ? s.bodies : s.count)) continue;
    return body ? "body " + s.name : s.name + " " + std::to_string(number + 1);
  }
  return (body ? "body " : "particle ") + std::to_string(id_of(model, entity));
}

std::vector<int> structure_of(const Model& model) {
  std::vector<int> of(entities(model), -1);
  for (int s = 0; s < static_cast<int>(model.structures.size()); ++s) {
    const Structure& t = model.structures[s];
    std::fill_n(of.begin() + t.first, t.count, s);
    std::fill_n(of.begin() + model.particles() + t.first_body, t.bodies, s);
  }
  return of;
}

double size_of(const Model& model, int entity) {
  if (is_body(model, entity)) return 2 * model.shapes[model.bodies[entity - model.particles()].shape].bounding_radius();
  return model.diameter[entity];
}

double largest_size(const Model& model) {
  double most = 0;
  for (int e = 0; e < entities(model); ++e) most = std::max(most, size_of(model, e));
  return most;
}

double smallest_size(const Model& model) {
  double least = 0;
  for (int e = 0; e < entities(model); ++e)
    if (const double size = size_of(model, e); size > 0 && (least == 0 || size < least)) least = size;
  return least;
}

Vec3 sides_of(const State& state) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index p = 0; p < state.particles(); ++p) box.extend(Vec3(state.position.col(p)));
  for (const Pose& b : state.bodies) box.extend(b.position.hi);
  return box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.sizes());
}

Eigen::AlignedBox3d box_of(const Model& model, const State& state) {
  Eigen::AlignedBox3d box;
  for (int e = 0; e < entities(model); ++e) {
    const Vec3 x = is_body(model, e) ? state.bodies[e - model.particles()].position.hi : Vec3(state.position.col(e));
    for (const double r : {-size_of(model, e) / 2, size_of(model, e) / 2}) box.extend(Vec3(x + Vec3::Constant(r)));
  }
  return box;
}

}  // namespace elamin
