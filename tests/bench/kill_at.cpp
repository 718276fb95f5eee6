// Loaded before the C library (LD_PRELOAD), kills the program at a call that changes a file:
//
//     KILL_AT=K         before the K-th one; where that is a write, with half of its bytes written
//     KILL_TELL=FILE    never: writes how many there were to FILE
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

std::atomic<long> count;
long at = 0;

[[gnu::constructor]] void begin() {
  if (const char* text = std::getenv("KILL_AT")) at = std::atol(text);
}
[[gnu::destructor]] void tell() {
  const char* name = std::getenv("KILL_TELL");
  std::FILE* file = name ? std::fopen(name, "w") : nullptr;
  if (!file) return;
  std::fprintf(file, "%ld\n", count.load());
  std::fclose(file);
}

bool is_last() { return ++count == at; }
[[noreturn]] void die() {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}

template <class F> F* real(F*, const char* name) { return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name)); }

}  // namespace

#define CHANGES(type, name, parameters, arguments)          \
  extern "C" type name parameters {                         \
    static auto* const original = real(&name, #name);       \
    if (is_last()) die();                                   \
    return original arguments;                              \
  }

CHANGES(int, rename, (const char* from, const char* to) noexcept, (from, to))
CHANGES(int, unlinkat, (int folder, const char* file, int flags) noexcept, (folder, file, flags))
CHANGES(int, remove, (const char* file) noexcept, (file))
CHANGES(int, mkdir, (const char* folder, mode_t mode) noexcept, (folder, mode))
CHANGES(int, ftruncate, (int descriptor, off_t size) noexcept, (descriptor, size))
CHANGES(int, truncate, (const char* file, off_t size) noexcept, (file, size))
CHANGES(int, fsync, (int descriptor), (descriptor))
CHANGES(int, syncfs, (int descriptor) noexcept, (descriptor))

extern "C" ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  static auto* const original = real(&write, "write");
  if (descriptor > STDERR_FILENO && is_last()) {
    original(descriptor, bytes, size / 2);
    die();
  }
  return original(descriptor, bytes, size);
}
