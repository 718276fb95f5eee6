#pragma once
// Long work tells what it is doing; whoever waits for it looks now and then from a thread of its own.
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace elamin {

namespace detail {
/// What a thread is doing, to be read by another one.
struct Work {
  std::atomic<const char*> doing{""};
  std::atomic<int> iteration{-1};                // of a solver; −1: none has begun
  std::atomic<double> residual{0};
};
inline thread_local Work* work = nullptr;        // of a heartbeat, if there is one
}  // namespace detail

/// A solver of this thread is at this iteration, with this residual.
inline void at_iteration(int k, double residual) {
  if (!detail::work) return;
  detail::work->residual = residual, detail::work->iteration = k;
}

/// As long as it lives this thread does what the words say, which must be a literal: "factorising".
class Doing {
 public:
  explicit Doing(const char* what) : before_(detail::work ? detail::work->doing.exchange(what) : "") {}
  ~Doing() {
    if (detail::work) detail::work->doing = before_;
  }
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

 private:
  const char* before_;
};

/// As long as it lives `on_beat` is called every `seconds`, from another thread, with what the thread that made it is doing, as far as that
/// tells: "iteration 7", "residual 3e-05", "factorising". What on_beat throws is dropped.
class Heartbeat {
 public:
  using OnBeat = std::function<void(const std::vector<std::string>& doing)>;
  Heartbeat(double seconds, OnBeat on_beat);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void beat(double seconds, const OnBeat& on_beat);

  detail::Work work_;
  detail::Work* before_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::jthread thread_;                          // last: it looks at the others
};

}  // namespace elamin
