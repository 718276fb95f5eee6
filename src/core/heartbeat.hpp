#pragma once
// Long work tells now and then that it is at work.
#include <functional>
#include <utility>

namespace elamin {

namespace detail {
inline thread_local std::function<void()> on_beat;
}

/// Called between the iterations of long work, by interrupted().
inline void beat() {
  if (detail::on_beat) detail::on_beat();
}

/// As long as it lives each beat() of this thread calls `on_beat`.
class Heartbeat {
 public:
  explicit Heartbeat(std::function<void()> on_beat) : before_(std::exchange(detail::on_beat, std::move(on_beat))) {}
  ~Heartbeat() { detail::on_beat = std::move(before_); }
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  std::function<void()> before_;
};

}  // namespace elamin
