#include "laws/rounded/rigid_step.hpp"

#include "catch.hpp"
#include "laws/rounded/bodies.hpp"
#include "laws/rounded/lammps_case.hpp"

using namespace elamin;

namespace {

Wrenches all_forces(const ReferenceCase& c, const LammpsBodies& all) {
  Wrenches w = lammps_forces(c, all);
  for (std::size_t k = 0; k < all.state.size(); ++k) w.forces[k] += all.mass[k].mass * gravity_of(c);
  return w;
}

/// The largest difference from a snapshot, relative to max(1, size).
double off(const nlohmann::json& snapshot, const LammpsBodies& all, const Wrenches& w) {
  double worst = std::abs(w.energy - snapshot["pair_energy"].get<double>());
  const auto compare = [&](const Vec3& found, const nlohmann::json& j) {
    const Vec3 expected = vector_of(j);
    worst = std::max(worst, (found - expected).norm() / std::max(1.0, expected.norm()));
  };
  for (std::size_t k = 0; k < all.state.size(); ++k) {
    const RigidState& s = all.state[k];
    compare(s.pose.position.hi, snapshot["x"][k]);
    compare(s.velocity, snapshot["v"][k]);
    compare(s.angular_momentum, snapshot["angmom"][k]);
    compare(w.forces[k], snapshot["forces"][k]);
    compare(w.torques[k], snapshot["torques"][k]);
    const auto& q = snapshot["quat_relative"][k];
    const double sign = s.pose.rotation.w() < 0 ? -1 : 1;
    worst = std::max(worst, std::abs(sign * s.pose.rotation.w() - q[0].get<double>()));
    compare(sign * s.pose.rotation.vec(), {q[1], q[2], q[3]});
  }
  return worst;
}

}  // namespace

TEST_CASE("rigid bodies move as LAMMPS moves them", "[laws][rounded][lammps]") {
  for (const std::string name : {"dyn_spheres", "dyn_rod_box", "dyn_mu", "dyn_wall"}) {
    const ReferenceCase c = reference_case(name);
    const double dt = c.expected["dt"].get<double>();
    LammpsBodies all = at_start(c);
    Wrenches w = all_forces(c, all);
    int step = 0, compared = 0;
    const nlohmann::json& snapshots = c.expected["lammps"]["snapshots"];
    for (const auto& snapshot : snapshots) {
      for (; step < snapshot["step"].get<int>(); ++step) {
        for (std::size_t k = 0; k < all.state.size(); ++k) {
          kick(all.state[k], all.mass[k], {w.forces[k], w.torques[k]}, dt);
          drift(all.state[k], all.mass[k], dt);
        }
        w = all_forces(c, all);
        for (std::size_t k = 0; k < all.state.size(); ++k)
          kick(all.state[k], all.mass[k], {w.forces[k], w.torques[k]}, dt);
      }
      INFO(name << ", step " << step);
      CHECK(off(snapshot, all, w) <= 1e-11);
      ++compared;
    }
    CHECK(compared == 4);
  }
}

TEST_CASE("a free body keeps its energy of rotation, to second order in the time step", "[laws][rounded]") {
  const Mat3 R = quaternion({0.3, -1, 0.5}).toRotationMatrix();
  const RigidMass m(2, R * Vec3(1, 2, 3).asDiagonal() * R.transpose());
  const Vec3 L(0.3, 1.7, -0.4);
  const auto drift_of_energy = [&](double dt) {
    RigidState s;
    s.angular_momentum = L;
    double worst = 0;
    const double start = s.motion(m).angular_velocity.dot(L) / 2;
    for (int k = 0; k < 2 / dt; ++k)
      drift(s, m, dt), worst = std::max(worst, std::abs(s.motion(m).angular_velocity.dot(L) / 2 - start));
    return worst;
  };
  const double coarse = drift_of_energy(0.02), fine = drift_of_energy(0.01);
  CHECK(coarse > 0);
  CHECK(coarse < 1e-4);
  CHECK(fine < coarse / 3.5);
}

TEST_CASE("about an axis without inertia a body does not spin", "[laws][rounded]") {
  const RigidMass rod(1, Vec3(1e-9, 2, 2).asDiagonal());
  RigidState s;
  s.angular_momentum = {5, 0, 1};
  CHECK(s.motion(rod).angular_velocity == Vec3(0, 0, 0.5));
}
