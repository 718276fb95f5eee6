#include "model/imperfection.hpp"

#include "model/append.hpp"
#include "model/distinct.hpp"
#include "model/geometry.hpp"

#include <algorithm>

namespace elamin {
namespace {

double length_of(const Model& model, const Bond& b) { return norm(model.start.at(b.particles[1]) - model.start.at(b.particles[0])).value(); }
double angle_of(const Model& model, const Angle& a) {
  return angle_at(model.start.at(a.particles[1]), model.start.at(a.particles[0]), model.start.at(a.particles[2]));
}

/// New types, one for each old one and distinct change of its rest.
template <class Type, class Element>
void change_rest(Model& model, std::vector<Type>& types, std::vector<Element>& elements, double Type::*rest, const std::vector<double>& change,
                 double same) {
  std::vector<double> rests;
  for (std::size_t e = 0; e < elements.size(); ++e) rests.push_back(types[elements[e].type].*rest + change[e]);
  const std::vector<Type> old = types;
  std::vector<std::vector<std::size_t>> of(old.size());
  for (std::size_t e = 0; e < elements.size(); ++e) of[elements[e].type].push_back(e);
  types.clear();
  for (std::size_t t = 0; t < old.size(); ++t) {
    std::vector<double> theirs;
    for (const std::size_t e : of[t]) theirs.push_back(rests[e]);
    const int first = static_cast<int>(types.size());
    const Distinct d = distinct(theirs, first, same, same);
    // The first of a structure's types stays the first: `described` finds it.
    for (const double value : d.value) add_type(model, old[t]), types.back().*rest = value;
    if (d.value.empty()) add_type(model, old[t]);
    for (std::size_t k = 0; k < of[t].size(); ++k) elements[of[t][k]].type = d.type[k];
    for (Structure& s : model.structures) {
      int& its = static_cast<const void*>(&types) == &model.bond_types ? s.bond_type : s.angle_type;
      if (its == -2 - static_cast<int>(t)) its = first;
    }
  }
}

}  // namespace

void displace(Model& model, const Field& by, bool stress_free) {
  std::vector<double> lengths, angles;
  for (const Bond& b : model.bonds) lengths.push_back(length_of(model, b));
  for (const Angle& a : model.angles) angles.push_back(angle_of(model, a));
  for (int p = 0; p < model.particles(); ++p) {
    const ExactVector x = model.start.at(p), u = exact(Vec3(by.col(p)));
    ExactVector moved;
    for (int c = 0; c < 3; ++c) moved.set(c, x[c] + u[c]);
    model.start.set(p, moved);
    model.imperfection = std::max(model.imperfection, by.col(p).norm());
  }
  if (!stress_free) return;
  for (std::size_t b = 0; b < lengths.size(); ++b) lengths[b] = length_of(model, model.bonds[b]) - lengths[b];
  for (std::size_t a = 0; a < angles.size(); ++a) angles[a] = angle_of(model, model.angles[a]) - angles[a];
  for (Structure& s : model.structures) {                // marked while the types are renumbered
    if (s.bond_type >= 0) s.bond_type = -2 - s.bond_type;
    if (s.angle_type >= 0) s.angle_type = -2 - s.angle_type;
  }
  change_rest(model, model.bond_types, model.bonds, &BondType::rest_length, lengths, 16 * epsilon);
  change_rest(model, model.angle_types, model.angles, &AngleType::rest, angles, 16 * epsilon);
}

bool bends_a_row(const Model& model, const Field& by) {
  std::vector<bool> in_sheet(model.particles());
  for (const Structure& s : model.structures)
    if (s.kind == "sheet") std::fill_n(in_sheet.begin() + s.first, s.count, true);
  return std::any_of(model.angles.begin(), model.angles.end(), [&](const Angle& a) {
    const auto& [i, j, k] = a.particles;
    if (in_sheet[j] || model.angle_types[a.type].rest != pi) return false;
    const Vec3 left = model.start.position.col(j) - model.start.position.col(i), right = model.start.position.col(k) - model.start.position.col(j);
    const Vec3 turn = (by.col(k) - by.col(j)) / right.norm() - (by.col(j) - by.col(i)) / left.norm();
    return (turn - turn.dot(left) / left.squaredNorm() * left).norm() > 1e-9;
  });
}

}  // namespace elamin
