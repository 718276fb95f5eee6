// Rigid bodies by hand: four rounded boxes, each smaller than the one below, stand on a floor under their weight. Newton's
// method finds how deep each presses into what is below it: a face rests on four corners, so W/4k of the weight W above.
#include "model/rigid_body.hpp"
#include "solve/newton.hpp"

#include <cstdio>
#include <cstdlib>

using namespace elamin;

int main() {
  const double k = 1000, rounding = 0.1, height = 0.5;
  std::vector<RigidBody> boxes;
  for (int i = 0; i < 4; ++i) {
    RigidBody box;
    box.name = "box " + std::to_string(i + 1);
    box.core = box_core(Vec3(1 - 0.2 * i, 1 - 0.2 * i, height - 2 * rounding)), box.radius = rounding, box.density = 1;
    box.pose.position.hi = Vec3(0, 0, (i + 0.5) * height);
    box.pose.rotation = quaternion(Vec3(0, 0, 0.1 * i));
    boxes.push_back(box);
  }
  Model model;
  add_bodies(model, boxes);

  const std::vector<int> all{0, 1, 2, 3};
  RoundedPair contact;
  contact.bodies = {all, all}, contact.kernel.normal = k;
  model.rounded = {contact};
  Wall floor;
  floor.name = "floor", floor.bodies = all, floor.kernel.normal = k;
  floor.region.shape = Shape::plane, floor.region.normal = Vec3::UnitZ();
  model.walls = {floor};
  Support middles;                                               // without friction a box would slide off the one below
  middles.bodies = all, middles.held = {true, true, false};
  model.supports = {middles};
  Gravity gravity;
  gravity.bodies = all, gravity.acceleration = Vec3(0, 0, -1);
  model.gravity = {gravity};

  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  const Report report = newton.minimise(state);
  std::printf("%s, after %d iterations\n", report.why.c_str(), report.iterations);

  double above = 0, worst = 0;
  for (int i = 3; i >= 0; --i) {
    const double z = state.bodies[i].position.hi.z(), below = i > 0 ? state.bodies[i - 1].position.hi.z() : -height / 2;
    above += model.bodies[i].mass;
    const double overlap = height - (z - below), expected = above / (4 * k);
    std::printf("box %d bears %.6f and presses %.12f into what is below, of W/4k = %.12f\n", i + 1, above, overlap, expected);
    worst = std::max(worst, std::abs(overlap / expected - 1));
  }
  return report.converged() && worst < 1e-9 ? EXIT_SUCCESS : EXIT_FAILURE;
}
