#include "model/loop.hpp"

#include "model/append.hpp"
#include "model/geometry.hpp"

namespace elamin {

double chord(double radius, int particles) {
  return (exact(2) * exact(radius) * cosine_sine(exact(0.5) / exact(particles)).sine).value();
}

double ring_angle(int particles) { return (exact_pi * (exact(particles - 2) / exact(particles))).value(); }

void add_loops(Model& model, const std::vector<Ring>& rings) {
  int more = 0;
  for (const Ring& ring : rings) more += ring.particles;
  Appender append(model, more);
  for (const Ring& ring : rings) {
    const int n = ring.particles, first = append.together(n, ring.diameter, ring.density);
    const Frame frame = frame_of(ring.normal);
    for (int k = 0; k < n; ++k) {
      const auto [cosine, sine] = cosine_sine(exact(k) / exact(n));
      model.start.set(first + k, frame.point(ring.center, exact(ring.radius) * cosine, exact(ring.radius) * sine));
    }
    const bool bends = ring.angle.stiffness > 0;
    const int bond_type = add_type(model, ring.bond), angle_type = bends ? add_type(model, ring.angle) : -1;
    const auto around = [&](int k) { return first + (k < n ? k : k - n); };
    for (int k = 0; k < n; ++k) model.bonds.push_back({bond_type, {around(k), around(k + 1)}});
    for (int k = 0; bends && k < n; ++k) model.angles.push_back({angle_type, {around(k), around(k + 1), around(k + 2)}});
    model.structures.push_back({ring.name, "loop", first, n, ring.youngs_modulus, bond_type, angle_type});
  }
}

}  // namespace elamin
