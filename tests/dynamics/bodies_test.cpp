// Rigid bodies in motion: LAMMPS's trajectories, what is conserved and how exactly, what carries and what is held.
#include "catch.hpp"
#include "chain.hpp"
#include "core/error.hpp"
#include "dynamics/body_case.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "dynamics/verlet.hpp"
#include "energy/energy.hpp"

using namespace elamin;

namespace {

int add_body(Model& m, const CoreMesh& core, double radius, const Vec3& x, const Vec3& turned, double mass = 1) {
  m.shapes.push_back(rounded_shape(core, radius));
  const MassProperties p = mass_properties(m.shapes.back());
  const int b = static_cast<int>(m.bodies.size());
  m.bodies.push_back({b, m.particles() + b + 1, 1, mass, mass / p.volume * p.inertia});
  m.start.bodies.push_back({{x, Vec3::Zero()}, quaternion(turned)});
  return b;
}

RoundedPair& feel(Model& m, RoundedFormulation formulation, RoundedDamping damping = {}) {
  RoundedPair t;
  for (int side = 0; side < 2; ++side) {
    for (int p = 0; p < m.particles(); ++p) t.particles[side].push_back(p);
    for (int b = 0; b < static_cast<int>(m.bodies.size()); ++b) t.bodies[side].push_back(b);
  }
  t.formulation = formulation, t.kernel = {100, 2, 0.2, RoundedKernel::Form::coded}, t.damping = damping;
  m.rounded.push_back(t);
  return m.rounded.back();
}

// A chain, two of whose particles a box carries, and three more bodies that fly about and into it.
Model swarm(RoundedDamping damping = {}) {
  Model m = chain(6, 60, 1, 0.6);
  const Vec3 along = Vec3::UnitZ();
  add_body(m, box_core(Vec3(0.8, 0.6, 0.5)), 0.15, Vec3(0.1, -0.05, -0.4), Vec3(0.3, -0.2, 0.1), 2);
  add_body(m, cube_core(0.7), 0.15, Vec3(1.05, 0.1, -0.3), Vec3(0.4, 0.3, -0.7));
  add_body(m, rod_core(1.2), 0.2, Vec3(-0.1, -0.75, 0.9), Vec3(-0.2, 0.5, 0.9));
  add_body(m, tetrahedron_core(0.9), 0.1, 2.4 * along + Vec3(0.1, 0.95, 0.2), Vec3(1, 0.2, -0.5));
  for (const int p : {0, 1})
    m.glued.push_back({p, 0, m.start.bodies[0].rotation.conjugate() * (Vec3(m.start.position.col(p)) - m.start.bodies[0].position.hi)});
  for (Bond& b : m.bonds) b.type = 0;
  m.body_velocity.resize(3, 4), m.angular_momentum.resize(3, 4);
  m.body_velocity << 0.2, -0.6, 0.1, 0, 0.1, 0, 0.5, -0.6, 0, 0.1, 0.2, -0.1;
  m.angular_momentum << 0.1, -0.1, 0.2, 0.05, 0.2, 0.1, 0.1, -0.1, -0.3, 0.2, 0.05, 0.1;
  feel(m, RoundedFormulation::multi, damping);
  return m;
}

double balance_of_bodies(Energy& energy, const Verlet& verlet) {
  const Motion& m = verlet.motion();
  return verlet.kinetic() + energy.value(m.state) + m.dissipation - m.work;
}

double imbalance_of_bodies(const Model& m, double dt, double time) {
  Energy energy(m);
  Verlet verlet(m, begin_motion(m), dt);
  const double before = balance_of_bodies(energy, verlet);
  double worst = 0;
  for (int k = 0; k < 20; ++k) {
    verlet.advance(std::lround(time / dt / 20));
    worst = std::max(worst, std::abs(balance_of_bodies(energy, verlet) - before));
  }
  CHECK(verlet.finite());
  return worst;
}

// Momentum and angular momentum about the origin.
std::array<Vec3, 2> momenta(const Model& m, const Motion& now) {
  std::array<Vec3, 2> p{Vec3::Zero(), Vec3::Zero()};
  const auto add = [&](double mass, const Vec3& x, const Vec3& v) { p[0] += mass * v, p[1] += mass * x.cross(v); };
  for (int i = 0; i < m.particles(); ++i) add(m.mass(i), now.state.position.col(i), now.velocity.col(i));
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    add(m.bodies[b].mass, now.state.bodies[b].position.hi, now.body_velocity.col(b));
    p[1] += now.angular_momentum.col(b);
  }
  for (const Glued& g : m.glued) {
    const RigidState s{now.state.bodies[g.body], Vec3::Zero(), now.angular_momentum.col(g.body)};
    const double moment = 0.1 * m.mass(g.particle) * m.diameter[g.particle] * m.diameter[g.particle];
    p[1] += moment * s.motion({m.bodies[g.body].mass, m.bodies[g.body].inertia}).angular_velocity;
  }
  for (int i = 0; i < now.angular_velocity.cols(); ++i)
    if (std::none_of(m.glued.begin(), m.glued.end(), [&](const Glued& g) { return g.particle == i; }))
      p[1] += 0.1 * m.mass(i) * m.diameter[i] * m.diameter[i] * now.angular_velocity.col(i);
  return p;
}

void same(const Motion& a, const Motion& b) {
  CHECK(a.state.position == b.state.position);
  CHECK(a.velocity == b.velocity);
  CHECK(a.body_velocity == b.body_velocity);
  CHECK(a.angular_momentum == b.angular_momentum);
  CHECK(a.body_force == b.body_force);
  CHECK(a.torque == b.torque);
  CHECK(a.dissipation == b.dissipation);
  CHECK(a.work == b.work);
  for (std::size_t k = 0; k < a.state.bodies.size(); ++k) {
    CHECK(a.state.bodies[k].position.hi == b.state.bodies[k].position.hi);
    CHECK(a.state.bodies[k].position.lo == b.state.bodies[k].position.lo);
    CHECK(a.state.bodies[k].rotation.coeffs() == b.state.bodies[k].rotation.coeffs());
  }
}

}  // namespace

TEST_CASE("bodies move as LAMMPS moves them", "[dynamics][bodies][lammps]") {
  for (const std::string name : {"dyn_spheres", "dyn_rod_box", "dyn_mu", "dyn_wall"}) {
    const ReferenceCase c = reference_case(name);
    const Model m = model_of_bodies(c);
    Verlet verlet(m, begin_motion(m), c.expected["dt"].get<double>());
    int compared = 0;
    for (const auto& snapshot : c.expected["lammps"]["snapshots"]) {
      verlet.advance(snapshot["step"].get<int>() - verlet.motion().step);
      INFO(name << ", step " << verlet.motion().step);
      const Motion& now = verlet.motion();
      double worst = 0;
      const auto compare = [&](const Vec3& found, const nlohmann::json& j) {
        worst = std::max(worst, (found - vector_of(j)).norm() / std::max(1.0, vector_of(j).norm()));
      };
      for (std::size_t k = 0; k < m.bodies.size(); ++k) {
        compare(now.state.bodies[k].position.hi, snapshot["x"][k]);
        compare(now.body_velocity.col(k), snapshot["v"][k]);
        compare(now.angular_momentum.col(k), snapshot["angmom"][k]);
        compare(now.body_force.col(k), snapshot["forces"][k]);
        compare(now.torque.col(k), snapshot["torques"][k]);
        const auto& q = snapshot["quat_relative"][k];
        const Eigen::Quaterniond r = now.state.bodies[k].rotation;
        const double sign = r.w() < 0 ? -1 : 1;
        worst = std::max(worst, std::abs(sign * r.w() - q[0].get<double>()));
        compare(sign * r.vec(), {q[1], q[2], q[3]});
      }
      const LammpsBodyForces rules = lammps_body_forces(m, now.state);
      CHECK(worst <= 1e-11);
      CHECK(std::abs(rules.energy - snapshot["pair_energy"].get<double>()) <= 1e-11);
      ++compared;
    }
    CHECK(compared == 4);
  }
}

TEST_CASE("bodies, glued particles and contacts keep energy to second order, momentum and angular momentum", "[dynamics][bodies]") {
  Model apart = swarm();
  apart.rounded.clear();
  const double smooth = imbalance_of_bodies(apart, 2e-3, 1.6) / imbalance_of_bodies(apart, 1e-3, 1.6);
  CHECK(smooth > 3.7);
  CHECK(smooth < 4.3);
  // Where contacts begin and end U″ jumps: three halvings together.
  const Model m = swarm();
  const double coarse = imbalance_of_bodies(m, 1e-3, 1.6), fine = imbalance_of_bodies(m, 1.25e-4, 1.6);
  CHECK(coarse < 2e-3);
  CHECK(fine > 1e-9);
  CHECK(coarse / fine > 0.7 * 64);
  Energy energy(m);
  Verlet verlet(m, begin_motion(m), 1e-3);
  const auto before = momenta(m, verlet.motion());
  double met = 0;
  for (int k = 0; k < 16; ++k) verlet.advance(100), met = std::max(met, std::abs(energy.terms(verlet.motion().state).body));
  CHECK(met > 0.05);
  const auto after = momenta(m, verlet.motion());
  CHECK((after[0] - before[0]).norm() <= 1e-12);
  CHECK((after[1] - before[1]).norm() <= 1e-5);               // of the turns of bodies: second order
  const Field f = energy.forces(verlet.motion().state);
  for (int b = 0; b < 4; ++b) {
    CHECK((f.col(energy.kinematics().place_of(b)) - verlet.motion().body_force.col(b)).norm() <= 1e-9);
    CHECK((energy.kinematics().characteristic_length(b) * f.col(energy.kinematics().rotation_of(b)) - verlet.motion().torque.col(b)).norm() <= 1e-9);
  }
}

TEST_CASE("what damping and friction of bodies take is counted", "[dynamics][bodies]") {
  RoundedDamping damping{0.5, 0.2, 0.4, 0.5, GENERATE(false, true)};
  Model m = swarm(damping);
  m.viscosity.push_back({{0, 1, 2, 3}, 0.1, {0, 2}});
  Wall floor;
  floor.region.shape = Shape::plane, floor.region.center = Vec3(0, -1.5, 0), floor.region.normal = Vec3::UnitY();
  floor.bodies = {0, 1, 2, 3}, floor.kernel.normal = 50, floor.body_damping = damping;
  m.walls.push_back(floor);
  Gravity g;
  g.bodies = {1, 2, 3}, g.particles = {0, 4, 5}, g.acceleration = Vec3(0, -1, 0.3);
  m.gravity.push_back(g);
  Load l;
  l.bodies = {1}, l.force = Vec3(0.2, 0.1, 0), l.point = Vec3(0.1, 0.2, 0.1), l.torque = Vec3(0.1, 0.05, -0.1), l.scaling = Scaling::constant();
  m.loads.push_back(l);
  const double coarse = imbalance_of_bodies(m, 1e-3, 1.6), fine = imbalance_of_bodies(m, 5e-4, 1.6);
  Verlet verlet(m, begin_motion(m), 1e-3);
  verlet.advance(1600);
  CHECK(verlet.motion().dissipation > 0.05);
  CHECK(coarse < 0.02 * verlet.motion().dissipation);
  CHECK(fine < 0.6 * coarse);
}

TEST_CASE("the same bits however the steps of bodies are divided", "[dynamics][bodies]") {
  Model m = swarm({0.5, 0.2, 0.4, 0.5, true});
  Support drive;
  drive.bodies = {3}, drive.velocity = Vec3(0.1, 0, 0), drive.held = {true, true, true};
  m.supports.push_back(drive);
  m.viscosity.push_back({{0, 3}, 0.1, {0}});
  Verlet whole(m, begin_motion(m), 1e-3), parts(m, begin_motion(m), 1e-3);
  whole.advance(700);
  for (const int n : {1, 99, 350, 7, 243}) parts.advance(n);
  same(whole.motion(), parts.motion());
}

TEST_CASE("a motion of bodies that is taken up goes on with the same bits", "[dynamics][bodies]") {
  Model m = swarm();
  m.glued.clear();
  m.rounded[0].particles = {};
  Verlet whole(m, begin_motion(m), 1e-3), first(m, begin_motion(m), 1e-3);
  whole.advance(500), first.advance(200);
  Verlet second(m, first.motion(), 1e-3);
  second.advance(300);
  for (std::size_t k = 0; k < m.bodies.size(); ++k)
    CHECK(second.motion().state.bodies[k].rotation.coeffs() == whole.motion().state.bodies[k].rotation.coeffs());
  CHECK(second.motion().body_velocity == whole.motion().body_velocity);
  CHECK(second.motion().angular_momentum == whole.motion().angular_momentum);
}

TEST_CASE("a support that drives a body does work", "[dynamics][bodies]") {
  Model m = swarm();
  m.glued.clear();
  Support drive;
  drive.bodies = {1}, drive.velocity = Vec3(-0.3, 0.05, 0.1), drive.constrained_rotations = {true, true, true};
  m.supports.push_back(drive);
  CHECK(imbalance_of_bodies(m, 1e-3, 1.6) > 0.7 * 64 * imbalance_of_bodies(m, 1.25e-4, 1.6));
  Verlet verlet(m, begin_motion(m), 1e-3);
  verlet.advance(1600);
  const Motion& now = verlet.motion();
  CHECK(std::abs(now.work) > 100 * imbalance_of_bodies(m, 1.25e-4, 1.6));
  CHECK((now.state.bodies[1].position.hi - m.start.bodies[1].position.hi - 1.6 * drive.velocity).norm() <= 1e-12);
  CHECK(now.state.bodies[1].rotation.coeffs() == m.start.bodies[1].rotation.coeffs());
  CHECK(now.angular_momentum.col(1).isZero(0));
}

TEST_CASE("a body moves with the mass of what it carries", "[dynamics][bodies]") {
  // A box with a heavy ball at its end spins about their common centre, which a force on the ball accelerates by F/M.
  Model m = chain(1, 1, 1, 0.8);
  m.bonds.clear(), m.angles.clear();
  const Vec3 arm(0.9, 0.2, -0.3);
  add_body(m, box_core(Vec3(1, 0.6, 0.4)), 0.1, -arm, Vec3::Zero(), 1.5);
  m.glued.push_back({0, 0, arm});
  m.density[0] = 4;
  m.body_velocity = Field::Zero(3, 1), m.angular_momentum = Field(m.bodies[0].inertia * Vec3(0.3, -0.4, 0.8));
  Load l;
  l.particles = {0}, l.force = Vec3(0.5, 0.2, 0.1), l.scaling = Scaling::constant();
  m.loads.push_back(l);
  const double M = m.mass(0) + 1.5;
  const auto center = [&](const Motion& now) -> Vec3 { return (m.mass(0) * now.state.position.col(0) + 1.5 * now.state.bodies[0].position.hi) / M; };
  const auto going = [&](const Motion& now) -> Vec3 { return (m.mass(0) * now.velocity.col(0) + 1.5 * now.body_velocity.col(0)) / M; };
  Verlet verlet(m, begin_motion(m), 1e-3);
  const Vec3 x = center(verlet.motion()), v = going(verlet.motion());
  CHECK(v.norm() > 0.1);
  verlet.advance(1000);
  CHECK((going(verlet.motion()) - v - l.force / M).norm() <= 1e-12);
  CHECK((center(verlet.motion()) - x - v - l.force / M / 2).norm() <= 1e-12);
  const Motion& now = verlet.motion();
  CHECK((now.state.position.col(0) - now.state.bodies[0].position.hi - now.state.bodies[0].rotation * arm).norm() <= 1e-14);
  CHECK((now.body_force.col(0) - l.force).norm() <= 1e-14);
  m.loads.clear();
  Verlet free(m, begin_motion(m), 1e-3);
  const auto before = momenta(m, free.motion());
  const double energy = free.kinetic();
  free.advance(2000);
  CHECK((momenta(m, free.motion())[0] - before[0]).norm() <= 1e-12);
  CHECK((momenta(m, free.motion())[1] - before[1]).norm() <= 1e-12);
  CHECK(free.kinetic() == Approx(energy).epsilon(1e-6));
}

TEST_CASE("a body with one free turn is a pendulum", "[dynamics][bodies]") {
  // Hung at its position, turning about z, a heavy ball at arm a: small swings of ω² = m g a/(I + m a² + 2/5 m r²).
  Model m = chain(1, 1, 1, 0.5);
  m.bonds.clear(), m.angles.clear();
  const double a = 1.2, g = 2, amplitude = 1e-4;
  add_body(m, box_core(Vec3(0.5, 0.4, 0.3)), 0.1, Vec3::Zero(), Vec3(0, 0, amplitude), 0.7);
  m.glued.push_back({0, 0, Vec3(0, -a, 0.1)});
  Gravity weight;
  weight.bodies = {0}, weight.particles = {0}, weight.acceleration = Vec3(0, -g, 0);
  m.gravity.push_back(weight);
  Support s;
  s.bodies = {0}, s.constrained_rotations = {true, true, false};
  m.supports.push_back(s);
  Energy energy(m);
  m.start = [&] { State at = m.start; energy.kinematics().prescribe(at, 0); return at; }();
  const double ball = m.mass(0), I = m.bodies[0].inertia(2, 2) + ball * a * a + 0.1 * ball * 0.25;
  const double period = 2 * pi / std::sqrt(ball * g * a / I);
  Verlet verlet(m, begin_motion(m), period / 4000);
  verlet.advance(1000);
  const auto angle = [&] { return 2 * std::atan2(verlet.motion().state.bodies[0].rotation.z(), verlet.motion().state.bodies[0].rotation.w()); };
  CHECK(std::abs(angle()) <= 1e-5 * amplitude);
  verlet.advance(1000);
  CHECK(angle() == Approx(-amplitude).epsilon(1e-5));
  CHECK(verlet.motion().state.bodies[0].position.hi == Vec3(0, 0, 0));
  CHECK(std::abs(verlet.motion().state.bodies[0].rotation.x()) <= 1e-15);
}

TEST_CASE("bodies that cannot move as they are held are refused", "[dynamics][bodies]") {
  const auto refused = [](const Model& m) {
    try {
      Verlet verlet(m, begin_motion(m), 1e-3);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  Model m = swarm();
  CHECK(refused(m).empty());
  m.bodies[1].mass = 0, m.bodies[2].mass = 0;
  CHECK(refused(m).find("2 bodies can move but have no mass (the last is body 9); dynamics needs a mass or a density") != std::string::npos);
  m = swarm();
  Support s;
  s.bodies = {0}, s.held = {true, false, false};
  m.supports = {s};
  CHECK(refused(m).find("the particles that body 7 carries move its centre of mass") != std::string::npos);
  m.supports[0].held = {true, true, true};
  CHECK(refused(m).empty());
  m.supports[0].velocity = Vec3(1, 0, 0);
  CHECK(refused(m).find("is driven by a support at a place that is not its centre of mass") != std::string::npos);
  m.supports[0].constrained_rotations = {true, true, true};
  CHECK(refused(m).empty());
}
