#include "catch.hpp"
#include "chain.hpp"
#include "core/heartbeat.hpp"
#include "core/timing.hpp"
#include "model/grains.hpp"
#include "solve/method.hpp"
#include "solve/settle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>

using namespace elamin;
using Catch::Matchers::Contains;

namespace {

// Grains at random above a floor, in a slot of the xz plane.
Model heap(int n, double unit, double modulus) {
  std::mt19937 random(4);
  const auto uniform = [&](double from, double to) { return unit * (from + (to - from) * (random() / 4294967296.0)); };
  Model m;
  Field x = Field::Zero(3, n);
  for (int i = 0; i < n; ++i) x(0, i) = uniform(-2, 2), x(2, i) = uniform(1, 0.5 * n);
  add_grains(m, {{"grains", x, std::vector<double>(static_cast<std::size_t>(n), unit), 1}});
  m.plane_normal = 1;
  PairContact contact;
  contact.particles = {numbers(n), numbers(n)}, contact.effective_modulus = modulus * unit;
  m.contacts.push_back(contact);
  Wall w;
  w.particles = numbers(n), w.effective_modulus = modulus * unit, w.region.normal = Vec3::UnitZ(), w.name = "floor";
  m.walls.push_back(w);
  w.region.normal = Vec3::UnitX(), w.region.center = Vec3(-2.5 * unit, 0, 0), w.name = "left";
  m.walls.push_back(w);
  w.region.normal = -Vec3::UnitX(), w.region.center = Vec3(2.5 * unit, 0, 0), w.name = "right";
  m.walls.push_back(w);
  weigh(m, 1);
  return m;
}

double on_floor(Energy& energy, const State& state) {
  double borne = 0;
  for (const Touch& t : energy.touches(state))
    if (t.wall == 0) borne += t.force[2];
  return borne;
}

}  // namespace

TEST_CASE("a packing settles on its floor, in any units and however stiff its grains are", "[solve][settle]") {
  for (const double unit : {1e-3, 1e3})
    for (const double modulus : {1e2, 1e5, 1e9}) {
      INFO("unit " << unit << ", modulus " << modulus);
      const Model m = heap(30, unit, modulus);
      Energy energy(m);
      Newton newton(energy);
      State state = m.start;
      const Report report = minimise(newton, state, AutoOptions{});
      INFO(report.why);
      REQUIRE(report.converged());
      CHECK_THAT(report.why, Contains("loose grains settled in"));
      CHECK(report.negative == 0);
      double weight = 0;
      for (int i = 0; i < m.particles(); ++i) weight += m.mass(i);
      CHECK(std::abs(on_floor(energy, state) - weight) <= 1e-9 * weight);     // 30 contacts, each to the residual 1e-10 of the largest
    }
}

TEST_CASE("a packing settles alike whatever its energy was asked before", "[solve][settle]") {
  const Model m = heap(30, 1, 1e5);
  State flying = m.start;
  for (int i = 0; i < m.particles(); ++i) flying.position(2, i) += 100 + 2 * i;
  std::vector<std::string> told;                                 // with the number of steps
  for (const bool asked : {false, true}) {
    Energy energy(m);
    if (asked) energy.evaluate(flying);
    Newton newton(energy);
    State state = m.start;
    const Report report = minimise(newton, state, AutoOptions{});
    CHECK(report.converged());
    told.push_back(report.why);
  }
  CHECK(told[0] == told[1]);
}

TEST_CASE("a bond beside a packing that bears far more than its grains weigh does not keep them from settling", "[solve][settle]") {
  std::vector<int> steps;
  for (const double stiffness : {0.0, 1e7}) {
    Model m = heap(102, 1, 1e5);                                 // the last two: held, with a stretched bond between them
    m.contacts[0].particles = {numbers(100), numbers(100)};
    for (Wall& w : m.walls) w.particles = numbers(100);
    for (const int p : {100, 101}) m.start.position.col(p) = Vec3(p, 0, -100);
    hold(m, 100, 101);
    m.bond_types = {{stiffness, 0.5}}, m.bonds = {{0, {100, 101}}};
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    const Report report = minimise(newton, state, AutoOptions{});
    INFO(report.why);
    CHECK(report.converged());
    steps.push_back(report.iterations);
  }
  CHECK(steps[1] <= 1.2 * steps[0]);                             // where they ended with the first force that is small beside the bond's: 2.9 times as many
}

TEST_CASE("a grain that stands on the top of a stiff column falls down, however little the column bends", "[solve][settle]") {
  for (const double B : {1e3, 1e9}) {
    INFO("bending stiffness " << B);
    Model m = chain(4, 10 * B, B, 1);
    hold(m, 0, 1);
    add_grains(m, {{"grain", Vec3(0, 0, 4), {1.0}, 1}});
    PairContact contact;
    contact.particles = {numbers(4), {4}}, contact.effective_modulus = 1e5;
    m.contacts.push_back(contact);
    Wall floor;
    floor.particles = {4}, floor.effective_modulus = 1e5, floor.region.center = Vec3(0, 0, -0.5), floor.region.normal = Vec3::UnitZ();
    m.walls.push_back(floor);
    weigh(m, 1);
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    const Report report = newton.minimise(state);
    INFO(report.why);
    CHECK(report.converged());
    CHECK(std::abs(state.position(2, 4)) < 1e-3);
  }
}

TEST_CASE("a packing without a floor falls, which is said", "[solve][settle]") {
  Model m = heap(25, 1, 1e4);
  m.walls.erase(m.walls.begin());
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  const Report report = minimise(newton, state, AutoOptions{});
  INFO(report.why);
  CHECK(report.status == Status::not_converged);
  CHECK((report.why.find("moves away without end") != std::string::npos || report.why.find("flies freely under a force") != std::string::npos));
}

TEST_CASE("without loose grains the method auto is Newton's", "[solve][settle]") {
  Model m = heap(25, 1, 1e4);
  m.supports.push_back({"", numbers(25), {true, true, true}, Vec3::Zero(), Scaling()});
  Energy energy(m);
  CHECK(unbonded_grains(energy) == 0);
  Newton newton(energy);
  State by_auto = m.start, by_newton = m.start;
  const Report a = minimise(newton, by_auto, AutoOptions{}), b = minimise(newton, by_newton, NewtonOptions{});
  CHECK(a.why == b.why);
  CHECK((by_auto.position.array() == by_newton.position.array()).all());
}

// Where everything parts the forces vanish, and the scale of a residual must not vanish with them.
TEST_CASE("grains that overlap in a box with room part until no force is left", "[solve][settle]") {
  std::mt19937 random(11);
  const auto uniform = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  for (int draw = 0; draw < 24; ++draw) {
    const int n = 4 + draw;                                       // from 20 on a packing
    const double unit = std::pow(10, uniform(-3, 3)), modulus = std::pow(10, uniform(0, 9)), half = 0.75 * std::cbrt(n) + 0.5;
    INFO("draw " << draw << ", unit " << unit << ", modulus " << modulus);
    Model m;
    Field x(3, n);
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) x(c, i) = unit * uniform(-half, half);
    add_grains(m, {{"grains", x, std::vector<double>(static_cast<std::size_t>(n), unit), 1}});
    PairContact contact;
    contact.particles = {numbers(n), numbers(n)}, contact.effective_modulus = modulus;
    m.contacts.push_back(contact);
    Wall box;
    box.name = "box", box.particles = numbers(n), box.effective_modulus = modulus, box.region.shape = Shape::block;
    box.region.lo = Vec3::Constant(-half * unit), box.region.hi = Vec3::Constant(half * unit);
    m.walls.push_back(box);
    Energy energy(m);
    for (const Method& method : {Method(NewtonOptions{}), Method(AutoOptions{})}) {
      Newton newton(energy);
      State state = m.start;
      const double before = energy.value(state);
      const Report report = minimise(newton, state, method);
      INFO(name_of(method) << ": " << report.why);
      CHECK(report.converged());
      CHECK(report.energy <= 1e-15 * before);                   // overlaps of the tolerance, 1e-10^{2/3} of a diameter, to the power 5/2
    }
  }
}

TEST_CASE("long work tells another thread what it does", "[solve][settle]") {
  const Model m = heap(30, 1, 1e5);
  Energy energy(m);
  std::mutex mutex;
  std::set<std::string> heard;
  const auto listen = [&](const std::vector<std::string>& doing) {
    const std::lock_guard lock(mutex);
    heard.insert(fmt::format("{}", fmt::join(doing, ", ")));
  };
  const auto hears = [&](const std::string& words) {             // in good time
    for (const Stopwatch watch; watch.seconds() < 20; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      const std::lock_guard lock(mutex);
      if (heard.count(words)) return true;
    }
    return false;
  };
  at_iteration(3, 1);                                            // nobody listens
  const Heartbeat outer(1e-3, [](const auto&) { throw std::runtime_error("is dropped"); });
  {
    const Heartbeat at_work(1e-3, listen);
    CHECK(hears(""));
    {
      const Doing ordering("ordering the unknowns");
      CHECK(hears("ordering the unknowns"));
      const Doing inner("factorising");
      at_iteration(7, 3e-5);
      CHECK(hears("iteration 7, residual 3e-05, factorising"));
    }
    CHECK(hears("iteration 7, residual 3e-05"));
    // A minimisation tells of its iterations and factors by itself.
    const auto told = [&] {
      const std::lock_guard lock(mutex);
      return std::count_if(heard.begin(), heard.end(), [](const std::string& h) { return h.starts_with("iteration") && h.find("iteration 7,") != 0; }) > 1;
    };
    Newton newton(energy);
    for (const Stopwatch watch; !told() && watch.seconds() < 20;) {
      State state = m.start;
      REQUIRE(minimise(newton, state, AutoOptions{}).converged());
    }
    CHECK(told());
  }
  const std::size_t before = heard.size();
  at_iteration(123456, 1);
  CHECK(heard.size() == before);
}
