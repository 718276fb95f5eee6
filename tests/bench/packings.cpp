// Random packings of loose grains, and how often and how fast their minimum is found by solver.method = "auto".
//
//     bench packings [--seed S] [--count M] [--grains N] [--least K] [--method NAME]
//
// Problem number k has the seed S + k (default S = 1, M = 10): N grains (default 200) at random in a box or in a cylinder, alike or of sizes that differ up to threefold,
// in space or in a plane, on a floor under their weight, with contacts between 1e2 and 1e9 times stiffer than what one weighs; lengths from 1e-3 to 1e3. A packing is
// right if the end is a minimum and the floor and the walls bear the whole weight to 1e-9. Prints a line for each, the share that is right, and the time; fails if fewer
// than K are (default: all). Method: auto or newton.
#include "core/memory.hpp"
#include "core/timing.hpp"
#include "model/grains.hpp"
#include "solve/method.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <string>

using namespace elamin;

namespace packings {

Model packing(int grains, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  const bool flat = random() % 2, alike = random() % 2, round = !flat && random() % 2;
  const double unit = std::pow(10, uniform(-3, 3)), stiff = std::pow(10, uniform(2, 9)), across = flat ? 2.0 * std::sqrt(grains / 2.0) : 1.2 * std::cbrt(grains);
  std::vector<double> diameter(static_cast<std::size_t>(grains));
  for (double& d : diameter) d = unit * (alike ? 1.0 : uniform(0.5, 1.5));
  Field x = Field::Zero(3, grains);
  const double high = across * 1.5, side = round ? across / std::sqrt(2.0) : across;
  for (int i = 0; i < grains; ++i) {
    x(0, i) = unit * uniform(-side / 2 + 0.75, side / 2 - 0.75);
    if (!flat) x(1, i) = unit * uniform(-side / 2 + 0.75, side / 2 - 0.75);
    x(2, i) = unit * uniform(0.8, high);
  }
  Model m;
  add_grains(m, {{"grains", x, diameter, 1.0}});
  if (flat) m.plane_normal = 1;
  std::vector<int> all(static_cast<std::size_t>(grains));
  std::iota(all.begin(), all.end(), 0);
  const double modulus = stiff * pi / 6 * unit;                   // of a weight ρ g π d³/6, ρ = g = 1, by d²
  PairContact contact;
  contact.particles = {all, all}, contact.effective_modulus = modulus;
  m.contacts = {contact};
  Wall floor;
  floor.name = "floor", floor.particles = all, floor.effective_modulus = modulus, floor.region.normal = Vec3::UnitZ();
  Wall around = floor;
  around.name = "around";
  if (round) {
    around.region.shape = Shape::cylinder, around.region.axis = 2, around.region.radius = unit * across / 2;
  } else {
    around.region.shape = Shape::block;
    around.region.lo = unit * Vec3(-across / 2, -across / 2, -1), around.region.hi = unit * Vec3(across / 2, across / 2, 100 * high);
  }
  m.walls = {floor, around};
  Gravity gravity;
  gravity.particles = all, gravity.acceleration = Vec3(0, 0, -1);
  m.gravity = {gravity};
  return m;
}

int main(int argc, char** argv) {
  keep_freed_memory();
  std::map<std::string, std::string> given{{"--seed", "1"}, {"--count", "10"}, {"--grains", "200"}, {"--least", ""}, {"--method", "auto"}};
  for (int k = 1; k + 1 < argc; k += 2) {
    if (!given.count(argv[k])) return fmt::print(stderr, "unknown option {}; see the head of tests/bench/packings.cpp\n", argv[k]), EXIT_FAILURE;
    given[argv[k]] = argv[k + 1];
  }
  const int count = std::stoi(given["--count"]), least = given["--least"].empty() ? count : std::stoi(given["--least"]);
  const unsigned seed = static_cast<unsigned>(std::stoul(given["--seed"]));
  const Method method = given["--method"] == "auto" ? Method(AutoOptions{}) : Method(NewtonOptions{});
  int right = 0;
  double longest = 0;
  const Stopwatch watch;
  for (int k = 0; k < count; ++k) {
    const Model model = packing(std::stoi(given["--grains"]), seed + static_cast<unsigned>(k));
    Energy energy(model);
    Newton newton(energy);
    State state = model.start;
    const Report report = minimise(newton, state, method);
    double weight = 0, borne = 0;
    for (int i = 0; i < model.particles(); ++i) weight += model.mass(i);
    for (const Touch& t : energy.touches(state))
      if (t.wall >= 0) borne += t.force[2];
    const bool good = report.converged() && std::abs(borne - weight) <= 1e-9 * weight;
    right += good, longest = std::max(longest, report.seconds);
    fmt::print("seed {:4}: {} {:6.2f} s, {:5} iterations, borne {:.12f} of the weight; {}\n", seed + static_cast<unsigned>(k), good ? "right" : "WRONG", report.seconds,
               report.iterations, borne / weight, report.why);
  }
  fmt::print("ended right: {} of {} ({:.1f} s, the longest {:.1f} s)\n", right, count, watch.seconds(), longest);
  return right >= least ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace packings
