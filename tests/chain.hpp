#pragma once
// Models made by hand for tests: straight chains with any ends.
#include "model/model.hpp"

#include <numeric>

namespace elamin {

/// first, first + 1, …: n of them.
inline std::vector<int> numbers(int n, int first = 0) {
  std::vector<int> v(n);
  std::iota(v.begin(), v.end(), first);
  return v;
}

/// A straight chain along `axis` with the first particle at the origin, spacing = rest length q0.
inline Model chain(int particles, double K, double B, double q0, const Vec3& axis = Vec3::UnitZ()) {
  Model m;
  m.start.position = Field::Zero(3, particles), m.start.low = Field::Zero(3, particles);
  const Vec3 direction = axis.normalized();
  for (int i = 0; i < particles; ++i)
    for (int c = 0; c < 3; ++c) {
      const Exact x = two_product(i * 1.0, q0) * Exact{direction[c], 0};
      m.start.position(c, i) = x.hi, m.start.low(c, i) = x.lo;
    }
  m.bond_types = {{K, q0}}, m.angle_types = {{B}};
  for (int i = 0; i + 1 < particles; ++i) m.bonds.push_back({0, {i, i + 1}});
  for (int i = 0; i + 2 < particles; ++i) m.angles.push_back({0, {i, i + 1, i + 2}});
  m.diameter.assign(particles, q0), m.density.assign(particles, 1);
  for (int i = 0; i < particles; ++i) m.id.push_back(i + 1);
  m.type.assign(particles, 1), m.molecule.assign(particles, 1);
  m.structures = {{"chain", "beam", 0, particles, 0, 0, 0}};
  return m;
}

/// Holds particles first … last in the given directions, moved by `displacement` at load factor 1.
inline void hold(Model& m, int first, int last, std::array<bool, 3> directions = {true, true, true}, Vec3 displacement = Vec3::Zero()) {
  Support s;
  for (int p = first; p <= last; ++p) s.particles.push_back(p);
  s.held = directions, s.displacement = displacement;
  m.supports.push_back(s);
}

/// Gravity g down z on all particles.
inline void weigh(Model& m, double g) { m.gravity.push_back({"", numbers(m.particles()), Vec3(0, 0, -g), Scaling::constant()}); }

/// Stiffnesses K and B of a round section of unit modulus and diameter 1, on spacing 1.
constexpr double round_bond = 3.14159265358979323846 / 8, round_angle = 3.14159265358979323846 / 64;

}  // namespace elamin
