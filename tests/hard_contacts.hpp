#pragma once
// Models with hard contacts, and what holds at their equilibria.
#include "catch.hpp"
#include "chain.hpp"
#include "solve/ipopt.hpp"

#include <numeric>

namespace elamin {

inline void meet_hard(Model& m) {
  PairContact c;
  c.particles = {numbers(m.particles()), numbers(m.particles())}, c.hard = true;
  m.contacts.push_back(c);
}

inline Wall& hard_plane(Model& m, const Vec3& point = Vec3::Zero()) {
  Wall w;
  w.name = "floor", w.particles = numbers(m.particles()), w.region.center = point, w.hard = true;
  m.walls.push_back(w);
  return m.walls.back();
}

// Nothing overlaps, nothing pulls, and where there is a force there is no gap.
inline void check_contacts(Energy& energy, const State& state, double tolerance = 1e-12) {
  const double diameter = energy.model().diameter[0];
  double largest = 0;
  HardGap gap;
  for (const HardForce& h : state.hard) largest = std::max(largest, h.force);
  for (const HardForce& h : state.hard) {
    REQUIRE(hard_gap(energy.model(), h, state, gap));
    CHECK(h.force > 0);
    CHECK(std::abs(gap.value) * h.force <= tolerance * diameter * largest);
  }
  for (const HardForce& h : energy.hard_contacts(state, 10 * diameter)) {
    REQUIRE(hard_gap(energy.model(), h, state, gap));
    CHECK(gap.value >= -tolerance * diameter);
  }
}

inline Report rest(Energy& energy, State& state) {
  energy.kinematics().prescribe(state, 1);
  const Report report = minimise_by_ipopt(energy, state, {});
  INFO(report.why << ", " << report.iterations << " iterations");
  REQUIRE(report.converged());
  CHECK(report.residual <= 1e-10);
  check_contacts(energy, state);
  return report;
}

}  // namespace elamin
