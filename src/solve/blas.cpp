#include "solve/blas.hpp"

#include <fmt/format.h>

#include <mutex>
#include <vector>

#include <sys/mman.h>

extern "C" {
void openblas_set_num_threads(int);
void* blas_memory_alloc(int);
void blas_memory_free(void*);
}

namespace elamin {

namespace {

constexpr std::size_t buffer = std::size_t{32} << 22;           // bytes that OpenBLAS takes for each call that is under way
constexpr std::size_t beside = std::size_t{16} << 20;           // and the least that a run takes beside it

bool there_is(std::size_t bytes) {
  void* const place = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return place != MAP_FAILED && munmap(place, bytes) == 0;
}

// A thread that calls OpenBLAS. As many buffers as there have been of them at a time are held at once when one more comes: so many will be there,
// whichever of them call at the same time.
class Caller {
 public:
  Caller() {
    const std::lock_guard lock(mutex_);
    if (callers_ == buffers_) take_another();
    ++callers_;
  }
  ~Caller() {
    const std::lock_guard lock(mutex_);
    --callers_;
  }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

 private:
  static void take_another() {
    if (!there_is(buffer + beside)) throw OutOfMemory(fmt::format("there is not enough memory: linear algebra works in {} MB for each thread (OpenBLAS)", buffer >> 20));
    std::vector<void*> held(++buffers_);
    for (void*& h : held) h = blas_memory_alloc(0);
    for (void* h : held) blas_memory_free(h);
  }

  inline static std::mutex mutex_;
  inline static std::size_t callers_ = 0, buffers_ = 0;
};

}  // namespace

void ready_blas() {
  static thread_local const Caller caller;
  openblas_set_num_threads(1);
}

}  // namespace elamin
