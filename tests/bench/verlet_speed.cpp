// Particle-steps per second of the velocity-Verlet engine.
//
//     bench verlet_speed FILE.toml TIMESTEP STEPS [POSITIONS]
//
// Takes so many steps of the problem's model from its start, on one thread, and prints the seconds of the processor that they took and the
// particle-steps per second. POSITIONS: a file for the final positions, a particle a line. Fails if a position is lost.
#include "dynamics/verlet.hpp"
#include "input/build.hpp"
#include "input/read.hpp"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

using namespace elamin;

namespace verlet_speed {

int main(int count, char** words) try {
  if (count < 4) {
    std::fputs("verlet_speed FILE.toml TIMESTEP STEPS [POSITIONS]\n", stderr);
    return 1;
  }
  const Model model = build_model(read_problem(words[1]));
  const std::int64_t steps = std::atoll(words[3]);
  Verlet verlet(model, begin_motion(model), std::atof(words[2]));
  const std::clock_t start = std::clock();
  const std::int64_t done = verlet.advance(steps);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%.6f s  %.4g particle-steps/s\n", seconds, static_cast<double>(done) * model.particles() / seconds);
  if (count > 4) {
    std::FILE* file = std::fopen(words[4], "w");
    if (!file) return 1;
    const Field& x = verlet.motion().state.position;
    for (Eigen::Index p = 0; p < x.cols(); ++p) std::fprintf(file, "%.17g %.17g %.17g\n", x(0, p), x(1, p), x(2, p));
    std::fclose(file);
  }
  return done == steps && verlet.finite() ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}

}  // namespace verlet_speed
