// A clamped sheet of ROWS × ROWS particles, indented by a moving sphere to LEVELS thicknesses: what a Newton iteration
// costs, and whether the assembly of the Hessian keeps its promises.
//
//     sheet_indentation [ROWS [LEVELS [SHARE]]]        default 100 4 75
//
// Prints for each level, on one and on two threads, the iterations, the seconds and the share of factorisations and
// solves in them; then the time of one assembly on one and on two threads, the heap allocations in it, and whether the
// bits agree between one and two threads and between two runs. Fails if something does not converge, if on one thread,
// where assembly takes longest, the share is below SHARE per cent, if an assembly allocates, or if bits differ.
#include "clamped_sheet.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/timing.hpp"
#include "solve/newton.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {
std::atomic<long> allocations{0};
}

// Every allocation on the heap: operator new, Eigen and OpenMP all end here. The sanitizers bring their own.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
constexpr bool counted = true;
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) { return ++allocations, __libc_malloc(n); }
void* calloc(std::size_t n, std::size_t size) { return ++allocations, __libc_calloc(n, size); }
void* realloc(void* p, std::size_t n) { return ++allocations, __libc_realloc(p, n); }
void* aligned_alloc(std::size_t alignment, std::size_t n) { return ++allocations, __libc_memalign(alignment, n); }
int posix_memalign(void** p, std::size_t alignment, std::size_t n) {
  return ++allocations, (*p = __libc_memalign(alignment, n)) ? 0 : 12;
}
}
#else
constexpr bool counted = false;
#endif

using namespace elamin;

namespace {

// The sphere, of radius 10, touches the middle at load factor 0 and sinks by `depth`.
Model indented_sheet(int rows, double depth) {
  Model model = clamped_sheet(rows - 1.0, (rows - 1) * std::sqrt(3) / 2);
  Wall sphere;
  sphere.name = "sphere", sphere.inside = false, sphere.effective_modulus = 1;
  sphere.region.shape = Shape::sphere, sphere.region.radius = 10, sphere.region.center = Vec3(0, 0, 10.5);
  sphere.displacement = Vec3(0, 0, -depth);
  for (int p = 0; p < model.particles(); ++p) sphere.particles.push_back(p);
  model.walls = {sphere};
  return model;
}

struct Path {
  bool all_converged = true;
  int iterations = 0;
  double seconds = 0, factor_seconds = 0;
  State state;

  double share() const { return 100 * factor_seconds / seconds; }
  void add(const Report& r) { add(r.converged(), r.iterations, r.seconds, r.factor_seconds); }
  void add(const Path& p) { add(p.all_converged, p.iterations, p.seconds, p.factor_seconds); }
  void add(bool converged, int its, double s, double factor_s) {
    all_converged = all_converged && converged;
    iterations += its, seconds += s, factor_seconds += factor_s;
  }
  void print(int threads, const std::string& level) const {
    std::printf("%7d %12s %11d %9.3f %11.1f %%%s\n", threads, level.c_str(), iterations, seconds, share(),
                all_converged ? "" : "   NOT CONVERGED");
  }
};

// Presses the sphere in by one thickness a level, in steps of less than a particle's radius: no centre gets inside it.
Path press(Energy& energy, int levels, int threads) {
  set_threads(threads);
  std::printf("\nthreads  thicknesses  iterations   seconds    in factors\n");
  Newton newton(energy);
  Path path;
  path.state = energy.model().start;
  for (int k = 1; k <= levels; ++k) {
    Path level;
    for (int step = 1; step <= 3; ++step) {
      energy.kinematics().prescribe(path.state, (k - 1 + step / 3.0) / levels);
      level.add(newton.minimise(path.state));
    }
    level.print(threads, std::to_string(k));
    path.add(level);
  }
  path.print(threads, "all");
  return path;
}

bool same_bits(const double* a, const double* b, Eigen::Index n) { return std::memcmp(a, b, n * sizeof(double)) == 0; }

bool same_bits(const State& a, const State& b) {
  return same_bits(a.position.data(), b.position.data(), a.position.size()) &&
         same_bits(a.low.data(), b.low.data(), a.low.size());
}

struct Assembly {
  double seconds = 1e300;              // the best of several
  long allocations = 0;                // in all after the first
  SparseMatrix hessian;
  Vector gradient;
};

Assembly assemble(Energy& energy, const State& state, int threads) {
  constexpr int times = 20;
  set_threads(threads);
  energy.evaluate(state);
  Assembly assembly;
  const long before = allocations;
  for (int k = 0; k < times; ++k) {
    const Stopwatch watch;
    energy.evaluate(state);
    assembly.seconds = std::min(assembly.seconds, watch.seconds());
  }
  assembly.allocations = allocations - before;
  assembly.hessian = energy.hessian(), assembly.gradient = energy.gradient();
  return assembly;
}

bool same_bits(const Assembly& a, const Assembly& b) {
  return same_bits(a.hessian.valuePtr(), b.hessian.valuePtr(), a.hessian.nonZeros()) &&
         same_bits(a.gradient.data(), b.gradient.data(), a.gradient.size());
}

const char* yes(bool b) { return b ? "yes" : "NO"; }

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  const int rows = argc > 1 ? std::atoi(argv[1]) : 100, levels = argc > 2 ? std::atoi(argv[2]) : 4;
  const double least_share = argc > 3 ? std::atof(argv[3]) : 75;
  if (rows < 8 || levels < 1) return std::fprintf(stderr, "at least 8 rows and 1 level\n"), EXIT_FAILURE;

  const Model model = indented_sheet(rows, levels);
  Energy energy(model), again(model);
  std::printf("%d particles, %d dofs, %ld non-zeros\n", model.particles(), energy.dofs(),
              long(energy.hessian().nonZeros()));
  const Path path = press(energy, levels, 1), shared = press(again, levels, 2);
  const Assembly one = assemble(energy, path.state, 1), two = assemble(energy, path.state, 2);
  std::printf("\none assembly: %.2f ms on one thread, %.2f ms on two, ratio %.2f\n", 1e3 * one.seconds,
              1e3 * two.seconds, one.seconds / two.seconds);
  if (counted)
    std::printf("allocations in 20 assemblies: %ld on one thread, %ld on two\n", one.allocations, two.allocations);
  const bool threads_agree = same_bits(one, two) && same_bits(path.state, shared.state);
  std::printf("the same bits on one and on two threads, assembly and path: %s\n", yes(threads_agree));
  const Path second = press(again, levels, 2);
  const bool runs_agree =
      same_bits(shared.state, second.state) && same_bits(two, assemble(again, second.state, 2));
  std::printf("\nthe same bits in a second run: %s\n", yes(runs_agree));

  const bool converged = path.all_converged && shared.all_converged && second.all_converged;
  const bool enough = path.share() >= least_share;
  if (!enough) std::printf("the share of factorisations and solves is below %g %% on one thread\n", least_share);
  const bool none = one.allocations + two.allocations == 0;
  const bool good = converged && enough && none && threads_agree && runs_agree;
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
