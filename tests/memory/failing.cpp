// Loaded before the C library (LD_PRELOAD), makes allocations fail:
//
//     FAIL_AT=K       the K-th one
//     FAIL_BEYOND=N   each one by which more than N bytes would be in use
//     FAIL_TELL=FILE  none: writes how many there were, and the most bytes in use, to FILE
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include <malloc.h>

// glibc's own names of what is defined here.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

std::atomic<long> count, in_use, most_in_use;
long at = 0, beyond = 0;

long number(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::atol(text) : 0;
}
[[gnu::constructor]] void begin() { at = number("FAIL_AT"), beyond = number("FAIL_BEYOND"); }
[[gnu::destructor]] void tell() {
  const char* name = std::getenv("FAIL_TELL");
  std::FILE* file = name ? std::fopen(name, "w") : nullptr;
  if (!file) return;
  std::fprintf(file, "%ld %ld\n", count.load(), most_in_use.load());
  std::fclose(file);
}

bool fails(std::size_t more) {
  if (++count != at && (beyond == 0 || in_use + static_cast<long>(more) <= beyond)) return false;
  errno = ENOMEM;
  return true;
}

std::size_t size_of(void* block) { return block ? malloc_usable_size(block) : 0; }

void* taken(void* block) {
  const long now = in_use += static_cast<long>(size_of(block));
  long most = most_in_use;
  while (now > most && !most_in_use.compare_exchange_weak(most, now)) {}
  return block;
}

void* aligned(std::size_t alignment, std::size_t size) { return fails(size) ? nullptr : taken(__libc_memalign(alignment, size)); }

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return fails(size) ? nullptr : taken(__libc_malloc(size)); }

void* calloc(std::size_t number, std::size_t size) { return fails(number * size) ? nullptr : taken(__libc_calloc(number, size)); }

void* realloc(void* block, std::size_t size) {
  const std::size_t had = size_of(block);
  if (fails(std::max(size, had) - had)) return nullptr;
  in_use -= static_cast<long>(had);
  return taken(__libc_realloc(block, size));
}

void* memalign(std::size_t alignment, std::size_t size) { return aligned(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return aligned(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* const got = aligned(alignment, size);
  if (!got) return ENOMEM;
  *block = got;
  return 0;
}

void free(void* block) {
  in_use -= static_cast<long>(size_of(block));
  __libc_free(block);
}

}  // extern "C"
