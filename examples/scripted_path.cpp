// A path by hand: a clamped column of 14 particles is shortened until it buckles; the program prints where, beside the
// closed form 2K(d − a) a = 4B sin²(π/(N + 2)), N = 10 free particles.
#include "laws/section.hpp"
#include "path/continuation.hpp"

#include <cstdio>
#include <cstdlib>

using namespace elamin;

int main() {
  const int n = 14;
  const double d = 1e-3, E = 0.96e6;
  const double K = bond_stiffness(Section::cylinder, E, d, d), B = angle_stiffness(Section::cylinder, E, d, d);
  Model model;
  Field x = Field::Zero(3, n);
  for (int i = 0; i < n; ++i) x(2, i) = i * d;
  model.start = State(x);
  model.bond_types = {{K, d}}, model.angle_types = {{B}};
  for (int i = 0; i + 1 < n; ++i) model.bonds.push_back({0, {i, i + 1}});
  for (int i = 0; i + 2 < n; ++i) model.angles.push_back({0, {i, i + 1, i + 2}});
  model.diameter.assign(n, d), model.density.assign(n, 800);
  model.plane_normal = 1;
  Support bottom, top;
  bottom.particles = {0, 1};
  top.particles = {n - 2, n - 1}, top.displacement = Vec3(0, 0, -d);       // load factor: shortening in diameters
  model.supports = {bottom, top};

  Energy energy(model);
  Newton newton(energy);
  PathOptions options;
  options.to = 0.3, options.steps = 20, options.when_unstable = WhenUnstable::stop;
  Continuation path(newton, model.start, options);
  double found = 0;
  while (const auto point = path.next()) {
    std::printf("%-9s load factor %.12f energy %.6e negative %d\n", point->label.c_str(), point->state.load_factor,
                point->energy.total(), point->stability.negative);
    if (point->label == "branch:1") found = point->state.load_factor;
  }
  const double s = std::sin(pi / 12);
  const double a = (1 + std::sqrt(1 - 8 * B * s * s / (K * d * d))) / 2;     // bond length in diameters at buckling
  const double exact = 11 * (1 - a);
  std::printf("buckles at %.15f, closed form %.15f\n", found, exact);
  return std::abs(found - exact) < 1e-9 * exact ? EXIT_SUCCESS : EXIT_FAILURE;
}
