// Branches that are families: an oval may slide along its ring at no cost, and is to stay where its symmetry keeps it.
#include "catch.hpp"
#include "input/build.hpp"
#include "input/read.hpp"
#include "scratch_directory.hpp"
#include "study/trace.hpp"

#include <cmath>

using namespace elamin;

namespace {

// A ring of n particles in the plane xy under pressure, held where no rigid motion is left and symmetry is not kept.
std::string ring(int n) {
  return "plane = \"xy\"\n[[loop]]\nname = \"ring\"\nparticles = " + std::to_string(n) +
         "\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\ndiameter = 0.05\naxial_stiffness = 1e5\nbending_stiffness = 1\n"
         "[[group]]\nname = \"one\"\nof = \"ring\"\nids = [3]\n[[group]]\nname = \"far\"\nof = \"ring\"\nids = [" + std::to_string(3 + n / 2) +
         "]\n[[support]]\ngroup = \"one\"\n[[support]]\ngroup = \"far\"\ndirections = \"y\"\n"
         "[[pressure]]\nloop = \"ring\"\npressure = 3\n"
         "[path]\nmethod = \"arc_length\"\nsteps = 20\nto = 1.2\nwhen_unstable = \"follow\"\nbranches = 1\npoints = 2000\n";
}

// How far the shape is from symmetric about one of its particles: the largest difference of the angles on both sides, for the best particle [rad].
double asymmetry(const State& state, int n) {
  std::vector<double> opened(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    const Vec3 u = state.position.col(k) - state.position.col((k + n - 1) % n), v = state.position.col((k + 1) % n) - state.position.col(k);
    opened[static_cast<std::size_t>(k)] = std::atan2(u.cross(v)[2], u.dot(v));
  }
  double best = 10;
  for (int k = 0; k < n; ++k) {
    double worst = 0;
    for (int j = 1; j <= n / 2; ++j)
      worst = std::max(worst, std::abs(opened[static_cast<std::size_t>((k + j) % n)] - opened[static_cast<std::size_t>((k + n - j) % n)]));
    best = std::min(best, worst);
  }
  return best;
}

}  // namespace

TEST_CASE("an oval stays symmetric about a particle, however its ring is held", "[path]") {
  for (const int n : {41, 54}) {
    const ScratchDirectory scratch;
    const Problem problem = read_problem(scratch.file("ring.toml", ring(n)));
    const Model model = build_model(problem);
    std::vector<PathPoint> points;
    const Sink sink{.stage = [](const Stage&, Energy&) {}, .point = [&](const PathPoint& p, bool) { points.push_back(p); },
                    .modes = [](const PathPoint&, const std::vector<Mode>&) {}, .note = [](const std::string&) {}};
    const Outcome outcome = trace(problem, model, {}, sink);
    INFO(n << " particles: " << outcome.why);
    REQUIRE(outcome.status == Status::converged);
    CHECK(points.back().state.load_factor == 1.2);
    double most = 0;
    int on_side = 0;
    for (const PathPoint& p : points)
      if (p.branch > 0) most = std::max(most, asymmetry(p.state, n)), ++on_side;
    CHECK(on_side > 10);
    CHECK(most <= 1e-6);                       // of angles that open by more than 0.1: rounding of the residual along what costs nothing
  }
}
