// What Newton's method does in one iteration on a large sheet: one line of the table that tests/bench/scale prints.
//
//     bench scale ROWS THREADS [FACTOR]
//     mpirun -n RANKS bench scale ROWS THREADS
//
// A clamped square sheet, of ROWS particles along a row, under its own weight. Prints the particles, the dofs, seconds for the making of the
// energy and for an assembly of gradient and Hessian, the analysis, a factorisation and a solution, each the best of three (the energy and
// the analysis are made once), the rate of the factorisation, its share of the rate that dgemm has on as many threads, measured here, the
// peak of the memory, and what a factor is estimated to take. FACTOR 0: neither analysis nor factor. Under mpirun the factor is that of all ranks, its
// analysis a part of the first factorisation, which is not told, and the memory that of rank 0.
#include "clamped_sheet.hpp"
#include "core/parallel.hpp"
#include "core/timing.hpp"
#include "energy/energy.hpp"
#include "solve/blas.hpp"
#include "solve/cholesky.hpp"
#include "solve/ordering.hpp"
#include "solve/ranks.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sys/resource.h>

extern "C" void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*, const double*,
                       const int*, const double*, double*, const int*);

using namespace elamin;

namespace scale {

Model sheet_under_weight(int rows) {
  Model model = clamped_sheet(rows - 1.0, rows - 1.0);
  Gravity weight;
  for (int p = 0; p < model.particles(); ++p) weight.particles.push_back(p);
  weight.acceleration = Vec3(0, 0, -1e-9);
  model.gravity = {weight};
  return model;
}

template <class Body>
double best_of(int rounds, const Body& body) {
  double best = 1e300;
  for (int k = 0; k < rounds; ++k) {
    const Stopwatch watch;
    body();
    best = std::min(best, watch.seconds());
  }
  return best;
}

// Of products of 1024 × 1024 matrices, one on each thread [operations/s].
double dgemm_rate(int threads) {
  const int n = 1024, rounds = 8;
  double rate = 0;
#pragma omp parallel num_threads(threads) reduction(+ : rate)
  {
    ready_blas();
    const std::vector<double> a(n * n, 1), b(n * n, 1);
    std::vector<double> c(n * n, 0);
    const double one = 1;
    const auto multiply = [&] { dgemm_("N", "T", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &one, c.data(), &n); };
    multiply();
#pragma omp barrier
    double best = 1e300;
    for (int k = 0; k < rounds; ++k) {
      const Stopwatch watch;
      multiply();
      best = std::min(best, watch.seconds());
    }
    rate = 2.0 * n * n * n / best;
  }
  return rate;
}

double peak_memory() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss * 1024.0;
}


void measure(int argc, char** argv) {
  const int rows = argc > 1 ? std::atoi(argv[1]) : 100, threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const bool factorise = argc <= 3 || std::atoi(argv[3]) != 0;
  set_threads(threads);
  ready_blas();
  const double rate = dgemm_rate(ranks() ? ranks()->size() : threads);
  const ShareFactorizations shared;
  const Model model = sheet_under_weight(rows);
  const Stopwatch making;
  Energy energy(model);
  const double made = making.seconds();
  const double assembly = best_of(3, [&] { energy.evaluate(model.start); });
  std::printf("%9d %9d %7d %9.4f %9.4f", model.particles(), energy.dofs(), threads, made, assembly);
  double memory = peak_memory();
  FactorSize size;
  if (factorise) {
    Cholesky cholesky;
    const double analysis = best_of(1, [&] { cholesky.analyze(energy.hessian()); });
    const double factor = best_of(3, [&] {
      if (!cholesky.factorize(energy.hessian())) std::fprintf(stderr, "not positive definite\n"), std::exit(1);
    });
    const double solution = best_of(3, [&] { const Vector x = cholesky.solve(energy.gradient()); });
    memory = peak_memory();
    size = factor_size(energy.hessian());
    const double done = size.operations / factor;
    std::printf(" %9.4f %9.4f %9.4f %7.1f %6.0f", analysis, factor, solution, done * 1e-9, 100 * done / rate);
  } else {
    size = factor_size(energy.hessian());
  }
  std::printf(" %8.3f %8.3f\n", memory * 1e-9, size.bytes() * 1e-9);
}

int main(int argc, char** argv) {
  Ranks* const all = join_ranks();
  if (all && all->rank() > 0) return all->serve(), leave_ranks(), 0;
  measure(argc, argv);
  if (all) all->release(Ranks::Release::end), leave_ranks();
  return 0;
}

}  // namespace scale
