// A chain that buckles: what a point of a path in arc length costs.
//
//     bench path_points [PARTICLES [POINTS [MOST]]]        default 1000 1000 0
//
// A chain in a plane, clamped at both ends, is compressed until it buckles at branch:1, and followed along both side
// branches, half of the points on each, at each of them with its Morse index under the load factor and held rigidly. One
// thread. Prints the times of one evaluation with Hessian, of one Cholesky factorisation of that Hessian and of a point,
// and the time of a point as a multiple of one evaluation and one factorisation. Fails if the branches are not there or
// are cut short, or if that is more than MOST (0: whatever it is).
#include "../chain.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "path/path.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace elamin;

namespace path_points {

// Seconds of the processor: a busy machine does not matter.
double seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// The median of so many calls [s].
template <class Call>
double seconds_of(const Call& call) {
  std::vector<double> times(101);
  for (double& t : times) {
    const double begun = seconds();
    call();
    t = seconds() - begun;
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

struct Traced {
  int points = 0, iterations = 0;      // behind the first point of the first side branch
  double seconds = 0;                  // of the processor
  bool whole = false;                  // both side branches, with all their points
  State last;
};

Traced follow(Newton& newton, const State& start, int points) {
  PathOptions options;
  options.method = PathMethod::arc_length, options.when_unstable = WhenUnstable::stop;
  options.branches = 1, options.steps = points, options.most_points = points / 2;
  const auto path = make_path(newton, start, options);
  Traced t;
  double begun = 0;
  int on_branch[3] = {};
  while (const auto point = path->next()) {
    if (point->label == "branch:1") std::printf("%s at load factor %.10g\n", point->label.c_str(), point->state.load_factor);
    if (point->branch < 1 || point->branch > 2) continue;
    if (++on_branch[point->branch] == 1 && point->branch == 1) begun = seconds();
    else ++t.points, t.iterations += point->report.iterations;
    t.last = point->state;
  }
  t.seconds = seconds() - begun;
  t.whole = path->status() == Status::converged && on_branch[1] >= points / 2 && on_branch[2] >= points / 2;
  std::printf("%s; %d and %d points on the side branches, the last at load factor %.4g\n", path->why().c_str(), on_branch[1], on_branch[2],
              t.last.load_factor);
  return t;
}

int main(int argc, char** argv) {
  keep_freed_memory();
  const int particles = argc > 1 ? std::atoi(argv[1]) : 1000, points = argc > 2 ? std::atoi(argv[2]) : 1000;
  const double most = argc > 3 ? std::atof(argv[3]) : 0;
  if (particles < 8 || points < 4) return std::fprintf(stderr, "at least 8 particles and 4 points\n"), EXIT_FAILURE;
  set_threads(1);

  // EA = 2, EI = 1/8 as of a square section of side 0.87; at load factor 1 the ends have come nearer by a third.
  Model model = chain(particles, 1, 0.125, 1);
  model.plane_normal = 1;
  hold(model, 0, 1), hold(model, particles - 2, particles - 1, {true, true, true}, Vec3(0, 0, -particles / 3.0));
  Energy energy(model);
  Newton newton(energy);
  std::printf("%d particles, %d dofs\n", particles, energy.dofs());
  const Traced traced = follow(newton, model.start, points);
  if (!traced.whole) return std::printf("the side branches are not whole\n"), EXIT_FAILURE;

  energy.evaluate(traced.last);
  const double evaluation = seconds_of([&] { energy.evaluate(traced.last); });
  bool definite = true;
  const double factorisation = seconds_of([&] { definite = newton.factors().try_cholesky(0) && definite; });
  if (!definite) return std::printf("the last point is not stable\n"), EXIT_FAILURE;
  const double point = traced.seconds / traced.points, multiple = point / (evaluation + factorisation);
  std::printf("%d points in %.2f s of the processor, %.1f iterations each\n", traced.points, traced.seconds, double(traced.iterations) / traced.points);
  std::printf("one evaluation %.3f ms, one factorisation %.3f ms, one point %.3f ms: %.1f times one evaluation and one factorisation\n",
              1e3 * evaluation, 1e3 * factorisation, 1e3 * point, multiple);
  return most > 0 && multiple > most ? EXIT_FAILURE : EXIT_SUCCESS;
}

}  // namespace path_points
