#pragma once
// Loops over the cores. Every index writes only its own places, so results have the same bits for any number of threads.
#include <omp.h>

#include <cstdint>

namespace elamin {

/// Threads that parallel_for uses when called from this thread; each sweep worker sets its own.
inline void set_threads(int n) { omp_set_num_threads(n < 1 ? 1 : n); }

/// body(i) for i in [0, count); on one thread where the loop is too short to share (`grain` indices a thread at least).
template <class Body>
void parallel_for(std::int64_t count, std::int64_t grain, const Body& body) {
  // OpenMP makes a team even of one thread, with a system call at its end.
  if (count < 2 * grain || omp_get_max_threads() == 1) {
    for (std::int64_t i = 0; i < count; ++i) body(i);
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i) body(i);
}

}  // namespace elamin
