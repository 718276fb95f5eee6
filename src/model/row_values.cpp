#include "model/row_values.hpp"

#include "model/append.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace elamin {
namespace {

/// The place in the structure of the particle that a bond goes on from, or −1.
int behind(const Structure& s, const Bond& b) {
  const int i = b.particles[0] - s.first, j = b.particles[1] - s.first;
  return i >= 0 && i < s.count && j == (i + 1) % s.count ? i : -1;
}
/// The place of the middle of an angle over neighbours, or −1.
int middle(const Structure& s, const Angle& a) {
  const int i = a.particles[0] - s.first, j = a.particles[1] - s.first, k = a.particles[2] - s.first;
  return i >= 0 && i < s.count && j == (i + 1) % s.count && k == (j + 1) % s.count ? j : -1;
}

double own(const std::vector<double>& values, int k, double standard) {
  return values.empty() || std::isnan(values[k]) ? standard : values[k];
}

/// A type of the model with these numbers, made if it is not there yet.
template <class Type>
int typed(Model& model, std::map<std::pair<double, double>, int>& known, double stiffness, double rest) {
  const auto [found, is_new] = known.try_emplace({stiffness, rest}, 0);
  if (is_new) found->second = add_type(model, Type{stiffness, rest});
  return found->second;
}

}  // namespace

std::vector<bool> has_bond_behind(const Model& model, const Structure& structure) {
  std::vector<bool> has(structure.count);
  for (const Bond& b : model.bonds)
    if (const int k = behind(structure, b); k >= 0) has[k] = true;
  return has;
}

std::vector<bool> has_angle_in_the_middle(const Model& model, const Structure& structure) {
  std::vector<bool> has(structure.count);
  for (const Angle& a : model.angles)
    if (const int k = middle(structure, a); k >= 0) has[k] = true;
  return has;
}

void set_own_values(Model& model, const Structure& structure, const OwnValues& values) {
  for (int k = 0; k < structure.count; ++k) {
    double& d = model.diameter[structure.first + k];
    double& rho = model.density[structure.first + k];
    d = own(values.diameter, k, d), rho = own(values.density, k, rho);
  }
  std::map<std::pair<double, double>, int> bonds, angles;
  if (!values.bond_stiffness.empty() || !values.rest_length.empty())
    for (Bond& b : model.bonds)
      if (const int k = behind(structure, b); k >= 0) {
        const BondType t = model.bond_types[b.type];
        b.type = typed<BondType>(model, bonds, own(values.bond_stiffness, k, t.stiffness), own(values.rest_length, k, t.rest_length));
      }
  if (!values.angle_stiffness.empty())
    for (Angle& a : model.angles)
      if (const int k = middle(structure, a); k >= 0) {
        const AngleType t = model.angle_types[a.type];
        a.type = typed<AngleType>(model, angles, own(values.angle_stiffness, k, t.stiffness), t.rest);
      }
}

}  // namespace elamin
