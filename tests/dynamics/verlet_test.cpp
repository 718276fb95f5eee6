// What velocity Verlet conserves, and how exactly.
#include "catch.hpp"
#include "chain.hpp"
#include "core/error.hpp"
#include "dynamics/contact_damping.hpp"
#include "dynamics/verlet.hpp"
#include "energy/energy.hpp"

#include <random>

using namespace elamin;

namespace {

Field random_velocity(int n, double size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, size);
  return Field::NullaryExpr(3, n, [&] { return normal(random); });
}

double balance(Energy& energy, const Verlet& verlet) {
  const Motion& m = verlet.motion();
  return verlet.kinetic() + energy.value(m.state) + m.dissipation - m.work;
}

// Two spheres of diameter 1 on the x axis that fly towards each other.
Model colliding(ContactDamping damping, double speed) {
  Model m;
  m.start = State(Field(3, 2));
  m.start.position << 0, 1.01, 0, 0, 0, 0;
  m.diameter = {1, 1}, m.density = {1, 3}, m.id = {1, 2}, m.type = {1, 1}, m.molecule = {1, 2};
  m.velocity = Field::Zero(3, 2);
  m.velocity(0, 0) = speed;
  PairContact c;
  c.between = {"all", "all"}, c.particles = {std::vector<int>{0, 1}, std::vector<int>{0, 1}};
  c.effective_modulus = 1e4, c.damping = damping;
  m.contacts = {c};
  return m;
}

// A chain whose end is driven, with drag: kinetic + potential + dissipation − work.
Model driven_chain() {
  Model m = chain(12, 100, 20, 1);
  m.velocity = random_velocity(12, 0.3);
  hold(m, 0, 1);
  hold(m, 10, 11);
  m.supports[1].velocity = Vec3(0.5, 0, -0.4);
  m.viscosity.push_back({{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, 0.3});
  return m;
}

double imbalance(const Model& m, double dt, double time) {
  Energy energy(m);
  Verlet verlet(m, begin_motion(m), dt);
  const double before = balance(energy, verlet);
  double worst = 0;
  const auto steps = static_cast<std::int64_t>(std::lround(time / dt / 20));
  for (int k = 0; k < 20; ++k) {
    verlet.advance(steps);
    worst = std::max(worst, std::abs(balance(energy, verlet) - before));
  }
  CHECK(verlet.motion().work != 0);
  CHECK(verlet.motion().dissipation > 0);
  return worst;
}

}  // namespace

TEST_CASE("the error falls with the square of the time step", "[dynamics]") {
  Model m = chain(8, 100, 20, 1);
  m.velocity = random_velocity(8, 0.5);
  hold(m, 0, 0);
  const auto at = [&](double dt) {
    Verlet verlet(m, begin_motion(m), dt);
    verlet.advance(std::lround(2 / dt));
    return verlet.motion().state.position;
  };
  const Field fine = at(1.0 / 65536);
  const double first = (at(1.0 / 512) - fine).norm(), second = (at(1.0 / 1024) - fine).norm();
  CHECK(first / second == Approx(4).epsilon(0.02));
}

TEST_CASE("the balance of energy, work and dissipation closes to the square of the time step", "[dynamics]") {
  const Model m = driven_chain();
  const double first = imbalance(m, 1.0 / 256, 5), second = imbalance(m, 1.0 / 512, 5), third = imbalance(m, 1.0 / 1024, 5);
  CHECK(first / second == Approx(4).epsilon(0.2));
  CHECK(second / third == Approx(4).epsilon(0.2));
}

TEST_CASE("friction and damping dissipate what the motion loses", "[dynamics]") {
  const auto lost = [](double dt) {
    Model m = colliding({ContactDamping::Model::viscoelastic, 3, 0.6, 0.3}, 1);
    m.velocity(1, 0) = 0.4;
    m.angular_velocity = random_velocity(2, 3);
    Energy energy(m);
    Verlet verlet(m, begin_motion(m), dt);
    const double before = balance(energy, verlet);
    verlet.advance(std::lround(0.2 / dt));
    CHECK(verlet.motion().dissipation > 0.005);
    CHECK(verlet.motion().angular_velocity.col(0) != m.angular_velocity.col(0));
    return std::abs(balance(energy, verlet) - before);
  };
  const double first = lost(2e-5), second = lost(1e-5);
  CHECK(first < 1e-6);
  CHECK(first / second > 3);
}

TEST_CASE("an undamped buckled column keeps its energy over a million steps", "[dynamics]") {
  // Shortened beyond its critical strain and bent aside: it swings about its buckled equilibria. Velocity Verlet follows a
  // nearby energy exactly, so the energy swings by (ω dt)²/8 of the vibrations there are and never drifts.
  Model m = chain(14, 100, 20, 1);
  hold(m, 0, 1), hold(m, 12, 13);
  for (int p = 0; p < 14; ++p) {
    m.start.position(2, p) *= 0.93;
    if (p > 1 && p < 12) m.start.position(0, p) = 0.5 * std::sin(pi * (p - 1) / 11.0);
  }
  m.start.low.setZero();
  Energy energy(m);
  const double mass = m.mass(0), dt = 0.1 * std::sqrt(mass / (8 * 100));
  Verlet verlet(m, begin_motion(m), dt);
  const double first = energy.value(m.start);
  std::array<double, 2> mean{};
  double swing = 0;
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 500; ++k) {
      REQUIRE(verlet.advance(1000) == 1000);
      const double change = balance(energy, verlet) - first;
      swing = std::max(swing, std::abs(change)), mean[half] += change / 500;
    }
  REQUIRE(verlet.motion().step == 1'000'000);
  CHECK(verlet.motion().dissipation == 0);
  CHECK(swing < 0.01 / 8 * first);                            // ω dt = 0.1 at most
  CHECK(std::abs(mean[1] - mean[0]) < 0.25 * swing);          // a steady drift alone would make it half of it; chance, a few hundredths
}

TEST_CASE("free bodies keep momentum and angular momentum to rounding", "[dynamics]") {
  Model m = chain(20, 100, 20, 1);
  m.velocity = random_velocity(20, 0.5);
  const auto moments = [&](const Motion& a) {
    Vec3 p = Vec3::Zero(), L = Vec3::Zero();
    for (int i = 0; i < 20; ++i) {
      const Vec3 momentum = m.mass(i) * a.velocity.col(i);
      p += momentum, L += a.state.position.col(i).cross(momentum);
    }
    return std::pair(p, L);
  };
  Verlet verlet(m, begin_motion(m), 1e-3);
  const auto [p, L] = moments(verlet.motion());
  verlet.advance(10'000);
  const auto [q, M] = moments(verlet.motion());
  const double largest = 20 * m.mass(0) * 0.5;
  CHECK((q - p).norm() < 1e4 * epsilon * largest);            // a random walk of roundings would give 10² of them
  CHECK((M - L).norm() < 1e4 * epsilon * largest * 20);
}

TEST_CASE("a tsuji collision loses what its damping takes, at any speed", "[dynamics]") {
  // With the damping γ √(m k √δ) beside k δ^{3/2} a collision is a damped oscillation in δ^{5/4}: its coefficient of
  // restitution is exp(−π γ/√(5 − γ²)). Source: Antypov & Elliott 2011, Europhys. Lett. 94, 50004.
  for (const double speed : {0.1, 1.0})
    for (const double e : {0.3, 0.6, 0.9}) {
      const double gamma = tsuji_coefficient(e);
      const Model m = colliding({ContactDamping::Model::tsuji, gamma, 0, 0}, speed);
      Verlet verlet(m, begin_motion(m), 1e-5);
      verlet.advance(std::lround(20'000 / speed));
      const Field& v = verlet.motion().velocity;
      CHECK(v(0, 1) - v(0, 0) == Approx(speed * std::exp(-pi * gamma / std::sqrt(5 - gamma * gamma))).epsilon(1e-3));
      CHECK(m.mass(0) * v(0, 0) + m.mass(1) * v(0, 1) == Approx(speed * m.mass(0)).epsilon(1e-12));
    }
  CHECK(tsuji_coefficient(1) == Approx(3e-4).epsilon(1e-6));
  CHECK(tsuji_coefficient(0) == 1.2728);
}

TEST_CASE("an elastic collision gives everything back", "[dynamics]") {
  const Model m = colliding({}, 1);
  Verlet verlet(m, begin_motion(m), 1e-5);
  verlet.advance(20'000);
  CHECK(verlet.motion().velocity(0, 1) - verlet.motion().velocity(0, 0) == Approx(1).epsilon(1e-6));
  CHECK(verlet.motion().angular_velocity.cols() == 0);
}

TEST_CASE("the bits do not depend on how the steps are divided", "[dynamics]") {
  const Model m = driven_chain();
  Verlet one(m, begin_motion(m), 0.01), many(m, begin_motion(m), 0.01);
  one.advance(100);
  for (int k = 0; k < 100; k += 4) many.advance(1), many.advance(3);
  CHECK(one.motion().state.position == many.motion().state.position);
  CHECK(one.motion().velocity == many.motion().velocity);
  CHECK(one.motion().work == many.motion().work);
  CHECK(one.motion().dissipation == many.motion().dissipation);
  CHECK(one.motion().state.position.col(11) == m.start.position.col(11) + Vec3(0.5 * (100 * 0.01), 0, -0.4 * (100 * 0.01)));
  CHECK(one.motion().state.position.col(0) == m.start.position.col(0));
}

TEST_CASE("a plane is kept, and single coordinates are held", "[dynamics]") {
  Model m = chain(6, 100, 20, 1);
  m.velocity = random_velocity(6, 0.5);
  m.plane_normal = 1;
  hold(m, 2, 2, {true, false, false});
  Verlet verlet(m, begin_motion(m), 1e-3);
  verlet.advance(1000);
  const Motion& end = verlet.motion();
  CHECK(end.state.position.row(1) == m.start.position.row(1));
  CHECK(end.state.position(0, 2) == m.start.position(0, 2));
  CHECK(end.state.position(2, 2) != m.start.position(2, 2));
}

TEST_CASE("what dynamics cannot move is refused", "[dynamics]") {
  Model m = colliding({}, 1);
  m.density[1] = 0;
  m.contacts[0].hard = true;
  try {
    Verlet(m, begin_motion(m), 1e-3);
    FAIL("moved");
  } catch (const InputError& e) {
    CHECK(std::string(e.what()).find("no mass") != std::string::npos);
    CHECK(std::string(e.what()).find("hard") != std::string::npos);
  }
}

TEST_CASE("a step that is far too long is noticed", "[dynamics]") {
  Model m = chain(8, 100, 20, 1);
  m.velocity = random_velocity(8, 0.5);
  Verlet verlet(m, begin_motion(m), 10);
  CHECK(verlet.advance(1'000'000'000) < 1'000'000'000);
  CHECK(!verlet.finite());
}
