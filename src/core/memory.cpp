#include "core/memory.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <string>

#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace elamin {
namespace {
std::atomic<void*> held_back = nullptr;
std::atomic<bool> was_short = false;
}

double all_memory() {
  rlimit limit;
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? std::min(there, static_cast<double>(limit.rlim_cur)) : there;
}

double free_memory() {
  std::ifstream file("/proc/meminfo");
  double free = 0, number = 0;
  std::string word;
  bool known = false;
  while (file >> word) {
    if (word != "MemAvailable:" && word != "SwapFree:") continue;
    if (file >> number) free += 1024 * number, known = true;
  }
  if (!known) free = std::numeric_limits<double>::infinity();
  rlimit limit;
  double pages = 0;
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && std::ifstream("/proc/self/statm") >> pages)
    free = std::min(free, static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGE_SIZE)));
  return free;
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);           // the largest that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_TOP_PAD, 1 << 20);
#endif
}

void hold_memory_back() {
  constexpr std::size_t enough = 1 << 20;        // for sentences, summary.json and the last state of some 10^4 particles
  held_back = std::malloc(enough);
  std::set_new_handler([] {
    give_held_memory();
    throw std::bad_alloc();
  });
}

void give_held_memory() noexcept {
  was_short = true;
  std::free(held_back.exchange(nullptr));
}

bool memory_was_short() noexcept { return was_short; }

}  // namespace elamin
