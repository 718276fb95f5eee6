// Contact by hand: five grains are dropped into a slot one and a half diameters wide and come to rest in a zigzag.
// Newton's method finds where, without the fall; then the program lists who touches what, and weighs the grains on
// the floor.
#include "model/grains.hpp"
#include "solve/newton.hpp"

#include <cstdio>
#include <cstdlib>
#include <numeric>

using namespace elamin;

int main() {
  const int n = 5;
  Grains grains;
  grains.name = "grains", grains.diameter.assign(n, 1.0), grains.density = 1;
  grains.position = Field::Zero(3, n);
  for (int i = 0; i < n; ++i) grains.position.col(i) << (i % 2 ? 0.2 : -0.2), 0, 0.6 + 1.1 * i;
  Model model;
  add_grains(model, {grains});
  model.plane_normal = 1;                                       // everything stays in the xz plane

  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  PairContact contact;
  contact.particles = {all, all}, contact.effective_modulus = 1e4;
  model.contacts = {contact};
  Wall box;
  box.name = "box", box.particles = all, box.effective_modulus = 1e4;
  box.region.shape = Shape::block, box.region.lo = Vec3(-0.75, -1, 0), box.region.hi = Vec3(0.75, 1, 10);
  model.walls = {box};
  Gravity gravity;
  gravity.particles = all, gravity.acceleration = Vec3(0, 0, -1);
  model.gravity = {gravity};

  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  const Report report = newton.minimise(state);
  std::printf("%s, after %d iterations\n", report.why.c_str(), report.iterations);

  double weight = 0, floor = 0;
  for (const int i : all) weight += model.mass(i);
  for (const Touch& t : energy.touches(state)) {
    const char* what = t.wall >= 0 ? "the box" : "another";
    std::printf("grain %d touches %s at (%7.4f, %7.4f) with the force %.6f\n", t.particle + 1, what, t.point[0],
                t.point[2], t.force.norm());
    if (t.wall >= 0) floor += t.force[2];
  }
  std::printf("weight %.15f, on the floor %.15f\n", weight, floor);
  return report.converged() && std::abs(floor - weight) < 1e-9 * weight ? EXIT_SUCCESS : EXIT_FAILURE;
}
