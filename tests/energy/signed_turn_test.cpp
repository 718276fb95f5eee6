// Curved angles in a plane, through the model: whichever way they bend as built, they may be bent straight and beyond.
#include "catch.hpp"

#include "energy/energy.hpp"
#include "laws/section.hpp"
#include "model/beam.hpp"

using namespace elamin;

TEST_CASE("a hump in a plane is at rest in its own sense, and pays for the other one", "[energy][angle]") {
  const double up = GENERATE(1.0, -1.0);
  const int normal = GENERATE(0, 1, 2);
  const int e = (normal + 1) % 3, f = (normal + 2) % 3;
  const double turn = 0.6, B = 3;
  const auto shape = [&](double half_turn) {
    std::vector<ExactVector> x(3);
    for (const int side : {0, 2}) {
      x[side].hi[e] = (side - 1) * std::cos(half_turn), x[side].hi[f] = -std::sin(half_turn);
    }
    return x;
  };
  Model model;
  model.plane_normal = normal;
  add_beams(model, {{"hump", shape(up * turn / 2), 1, 0, 0, {1, 1}, {B}, true}});
  REQUIRE(model.angle_types.at(model.angles.at(0).type).rest == Approx(pi - turn).epsilon(1e-15));
  Energy energy(model);
  CHECK(energy.terms(model.start).angle < 1e-30);
  for (const double now : {0.6, 0.1, 1e-3, 0.0, -1e-3, -0.6, -1.2}) {
    State state = model.start;
    const std::vector<ExactVector> x = shape(up * now / 2);
    for (int i = 0; i < 3; ++i) state.set(i, x[i]);
    CHECK(energy.terms(state).angle == Approx(B * (1 - std::cos(turn - now))).epsilon(1e-14).margin(1e-30));
  }
}
